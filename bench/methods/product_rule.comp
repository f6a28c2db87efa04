#version 460
#extension GL_GOOGLE_include_directive : require
// Product rule over the directions (theta_r, delta_phi) of the running beam. The other, fixed beam has the zenith angle
// theta. It has the integrand of beam_integrand() in direct_brdf.hpp. An invocation sums over some zeniths theta_r and
// all azimuths delta_phi, for one entry. Density, geometry and rotations use plain formulas. Fresnel reflectances and
// masking use the code of dolp.

#include "physics/prelude.glsl"
#include "interface.glsl"
#include "physics/buffers.glsl"
#include "physics/all.glsl"

layout(std430, binding = DOLP_BINDING_THETAS) readonly buffer Thetas { real2 thetas[]; };  // cos, sin of theta
layout(std430, binding = DOLP_BINDING_INDICES) readonly buffer Indices { IndexNode indices[]; };
// One per invocation: positions in `thetas`, `shapes` and `indices`; then first zenith + 65536 * number of zeniths.
layout(std430, binding = DOLP_BINDING_TASKS) readonly buffer Entries { uvec4 entries[]; };
// product[0].x is n. n zeniths follow (cos(theta_r), sin(theta_r), weight), then n azimuths (cos(delta_phi), weight).
layout(std430, binding = DOLP_BINDING_RULE) readonly buffer Product { real4 product[]; };
layout(std430, binding = DOLP_BINDING_MOMENTS) writeonly buffer Sums { real2 sums[]; };  // r_i, r_q

// The facet that reflects one beam into the other. Its slope is t = tan(alpha). phi_h is its azimuth relative to the
// fixed beam. Two components of the facet normal (t cos(phi_h), t sin(phi_h), 1) are perpendicular to the fixed beam:
// `along` in the vertical plane of this beam, and `across`, which is horizontal.
struct Bisector {
  real slope2;   // t^2
  real along;    // cos(theta) t cos(phi_h) - sin(theta)
  real across2;  // (t sin(phi_h))^2
  real cos_beta;
};

Bisector facet_between(real2 fixed_beam, real2 running, real cos_azimuth) {
  real height = fixed_beam.x + running.x;
  real away = fixed_beam.y - running.y;
  real side = running.y * running.y * (real(1.0) - cos_azimuth * cos_azimuth);
  real inverse = real(1.0) / height;
  Bisector facet;
  facet.slope2 = (away * away + real(2.0) * fixed_beam.y * running.y * (real(1.0) + cos_azimuth)) * inverse * inverse;
  facet.along = fixed_beam.x * (fixed_beam.y + running.y * cos_azimuth) * inverse - fixed_beam.y;
  facet.across2 = side * inverse * inverse;
  facet.cos_beta = real(0.5) * height * sqrt(real(1.0) + facet.slope2);
  return facet;
}

real attenuation(Row row, real2 lower, MaskingTerms of_lower, MaskingTerms of_higher, Bisector facet, real cos_alpha) {
  if (kMasking == DOLP_MASKING_NONE) return real(1.0);
  if (kMasking == DOLP_MASKING_V_CAVITY) return min(real(1.0), real(2.0) * cos_alpha * lower.x / facet.cos_beta);
  if (kMasking == DOLP_MASKING_SMITH) return real(1.0) / (real(1.0) + of_lower.value[0] + of_higher.value[0]);
  return real(1.0) - shadows(row, of_lower, lower.x, lower.y, sqrt(facet.slope2)).value[0];
}

void main() {
  uint i = push.first + min(gl_GlobalInvocationID.x, push.count - 1u);
  uvec4 entry = entries[i];
  Row row;
  row.shape[0] = shapes[entry.y];
  row.table[0] = entry.y * kMaskingNodes;
  real2 fixed_beam = thetas[entry.x];
  IndexNode index = indices[entry.z];
  MaskingTerms of_fixed = masking_of_direction(row, fixed_beam.x, fixed_beam.y);
  int nodes = int(product[0].x);
  int first = int(entry.w & 65535u);
  int zeniths = int(entry.w >> 16);
  real m2 = row.shape[0].m * row.shape[0].m;
  real q = row.shape[0].q_minus_1 + real(1.0);
  real2 sum = real2(real(0.0), real(0.0));
  for (int number = 0; number < zeniths; ++number) {
    real4 zenith = product[1 + first + number];
    real2 running = real2(zenith.x, zenith.y);
    MaskingTerms of_running = masking_of_direction(row, running.x, running.y);
    bool is_lower = running.x < fixed_beam.x;
    real2 lower = is_lower ? running : fixed_beam;
    MaskingTerms of_lower = of_fixed;
    MaskingTerms of_higher = of_running;
    if (is_lower) {
      of_lower = of_running;
      of_higher = of_fixed;
    }
    real2 azimuth_sum = real2(real(0.0), real(0.0));
    for (int column = 0; column < nodes; ++column) {
      real4 azimuth = product[1 + nodes + column];
      Bisector facet = facet_between(fixed_beam, running, azimuth.x);
      real cos2_alpha = real(1.0) / (real(1.0) + facet.slope2);
      real u2 = facet.slope2 / m2;
      real density = (kDistribution == DOLP_CAUCHY) ? (q - real(1.0)) * pow(real(1.0) + u2, -q) : exp(-u2);
      Fresnel f = fresnel(index, facet.cos_beta);
      real half_split = real(0.5) * f.split_over_sin2 * cos2_alpha;
      real along2 = facet.along * facet.along;
      real weight = azimuth.y * density / (cos2_alpha * cos2_alpha) *
                    attenuation(row, lower, of_lower, of_higher, facet, sqrt(cos2_alpha));
      azimuth_sum.x += weight * (f.r_s - half_split * (along2 + facet.across2));
      azimuth_sum.y += weight * (half_split * (along2 - facet.across2));
    }
    sum += zenith.z * azimuth_sum;
  }
  if (gl_GlobalInvocationID.x < push.count) sums[i] = sum / (kPi * m2);
}
