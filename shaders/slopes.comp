#version 460
#extension GL_GOOGLE_include_directive : require
// Sums over the azimuths at one slope per invocation, of maskings that do not depend on the slope distribution: they
// serve every distribution (host/compute/evaluate/kernel/slope_samples.hpp).

#include "physics/prelude.glsl"
#include "interface.glsl"
#include "physics/buffers.glsl"
#include "physics/all.glsl"

layout(std430, binding = DOLP_BINDING_THETAS) readonly buffer Thetas { ThetaNode thetas[]; };
layout(std430, binding = DOLP_BINDING_INDICES) readonly buffer Indices { IndexNode indices[]; };
layout(std430, binding = DOLP_BINDING_SLOPES) readonly buffer Slopes { SlopeNode slopes[]; };
layout(std430, binding = DOLP_BINDING_RULE) readonly buffer Rule { RuleNode rule; };
layout(std430, binding = DOLP_BINDING_AZIMUTHS) writeonly buffer AzimuthsOut { AzimuthNode azimuths[]; };
#if DOLP_MOST_SKY > 0
// The same buffer: r_i and r_q with each function of each slope, behind all AzimuthNodes.
layout(std430, binding = DOLP_BINDING_AZIMUTHS) writeonly buffer SkyOut { real sky_azimuths[]; };

void store_sky(uint slope, SkySums sums) {
  uint first = push.count * DOLP_AZIMUTH_NUMBERS + slope * 2u * kSkyCount;
  for (int k = 0; k < DOLP_MOST_SKY; ++k) {
    if (k < int(kSkyCount)) {
      sky_azimuths[first + uint(2 * k)] = sums.i[k];
      sky_azimuths[first + uint(2 * k + 1)] = sums.q[k];
    }
  }
}
#else
void store_sky(uint slope, SkySums sums) {}
#endif

void main() {
  uint i = gl_GlobalInvocationID.x;
  SlopeNode own = slopes[push.first + min(i, push.count - 1u)];
  ThetaNode theta;
  theta.c = thetas[int(own.theta)].c;
  theta.s = thetas[int(own.theta)].s;
  SlopeResult result = azimuths_of(rule, theta, indices[int(own.index)], own);
  if (i < push.count) {
    azimuths[i] = result.node;
    store_sky(i, result.sky);
  }
}
