#include "radiometry/reflectance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/smooth_surface.hpp"

namespace dolp {
namespace {

// Relative rounding error of a reflectance, which takes fewer than 8 operations on positive terms.
constexpr double kReflectanceRounding = 8.0 * std::numeric_limits<double>::epsilon();

}  // namespace

Reflectance reflectance(const Surface& surface, const Moments& moments, double cos_theta, const DiffuseLight& diffuse) {
  const double scale = surface.specular / cos_theta;
  const double absorbed_terms = (1.0 - surface.specular) + scale * std::abs(moments.deficit) + diffuse.i;
  Reflectance r;
  r.rho_i = scale * moments.r_i + diffuse.i;
  r.rho_q = scale * moments.r_q + diffuse.q;
  r.rho_u = scale * moments.r_u;
  r.absorbed = (1.0 - surface.specular) + scale * moments.deficit - diffuse.i;
  r.rho_i_error = scale * moments.r_i_error + kReflectanceRounding * std::abs(r.rho_i) + diffuse.error;
  r.rho_q_error = scale * moments.r_q_error + kReflectanceRounding * std::abs(r.rho_q) + diffuse.error;
  r.rho_u_error = moments.r_u == 0.0 ? 0.0 : scale * moments.r_q_error + kReflectanceRounding * std::abs(r.rho_u);
  r.absorbed_error = scale * moments.deficit_error + kReflectanceRounding * absorbed_terms + diffuse.error;
  r.mismatch = scale * std::abs((moments.r_i - cos_theta) + moments.deficit);
  return r;
}

bool is_unphysical(const Reflectance& r) {
  const double q = polarised_part(r.rho_q, r.rho_u);
  const double above = std::max(q - r.absorbed - r.absorbed_error, r.rho_i + q - 1.0 - r.rho_i_error);
  const double below = q - r.rho_i - r.rho_i_error;
  return std::max(above, below) > r.rho_q_error + kReflectanceRounding;
}

MeanWeights mean_weights(const SpectralRule& rule, double cos_theta) {
  const auto incident_light = [&](const SpectralSample& sample) {
    return sample.irradiance * cos_theta + sample.surroundings;
  };
  double emitted = 0.0;
  double incident = 0.0;
  for (const SpectralSample& sample : rule.samples) {
    emitted += sample.emitted;
    incident += incident_light(sample);
  }
  MeanWeights weights;
  for (const SpectralSample& sample : rule.samples) {
    double weight = sample.width;
    if (incident != 0.0) weight = incident_light(sample);
    if (emitted != 0.0) weight = sample.emitted;
    weights.list.push_back(weight);
    weights.total += weights.list.back();
  }
  if (rule.diffuse && emitted == 0.0 && incident != 0.0)
    weights.diffuse = rule.diffuse->surroundings + cos_theta * rule.diffuse->irradiance;
  return weights;
}

MeanReflectance mean_reflectance(const SpectralRule& rule, const PerSample<Reflectance>& reflectances,
                                 const MeanWeights& weights) {
  MeanReflectance mean;
  double rho_i_error = 0.0;
  double rho_q_error = 0.0;
  double rho_u_error = 0.0;
  for (std::size_t j = 0; j < reflectances.size(); ++j) {
    const Reflectance& r = reflectances[j];
    const double weight = weights.list[j];
    mean.rho_i += weight * r.rho_i;
    mean.rho_q += weight * r.rho_q;
    mean.rho_u += weight * r.rho_u;
    rho_i_error += std::abs(weight) * (r.rho_i_error + rule.relative_error * std::abs(r.rho_i));
    rho_q_error += std::abs(weight) * (r.rho_q_error + rule.relative_error * std::abs(r.rho_q));
    rho_u_error += std::abs(weight) * (r.rho_u_error + rule.relative_error * std::abs(r.rho_u));
  }
  const auto spectral_error = [&](double Reflectance::*rho) {
    return panel_error(rule, [&](std::size_t j, std::size_t m) { return weights.list[j] * (reflectances[m].*rho); });
  };
  rho_i_error += spectral_error(&Reflectance::rho_i);
  rho_q_error += spectral_error(&Reflectance::rho_q);
  rho_u_error += spectral_error(&Reflectance::rho_u);
  mean.rho_i = (mean.rho_i + weights.diffuse) / weights.total;
  mean.rho_q /= weights.total;
  mean.rho_u /= weights.total;
  mean.error = std::max({rho_i_error, rho_q_error, rho_u_error}) / weights.total;
  return mean;
}

Emissivity fresnel_emissivity(const FacetOptics& index, double cos_theta) {
  const SmoothAbsorptance absorptance = smooth_absorptance(index, cos_theta);
  const double mean = 0.5 * (absorptance.s + absorptance.p);
  return {.i = mean,
          .q = 0.5 * (absorptance.s - absorptance.p),
          .i_error = absorptance.error,
          .q_error = absorptance.error,
          .terms = mean};
}

Emissivity direct_emissivity(const Surface& surface, const Moments& moments, double cos_theta,
                             const DiffuseLight& diffuse) {
  const double scale = surface.specular / cos_theta;
  const double rest = 1.0 - surface.specular;
  if (surface.specular == 0.0) return {.i = rest - diffuse.i, .q = -diffuse.q, .terms = rest + diffuse.i};
  return {.i = scale * moments.direct_i + rest - diffuse.i,
          .q = scale * moments.direct_q - diffuse.q,
          .u = scale * moments.direct_u,
          .i_error = scale * moments.direct_i_error,
          .q_error = scale * moments.direct_q_error,
          .u_error = moments.direct_u == 0.0 ? 0.0 : scale * moments.direct_q_error,
          .terms = scale * std::abs(moments.direct_i) + rest + diffuse.i};
}

Emissivity kirchhoff_emissivity(const Reflectance& r) {
  return {.i = r.absorbed,
          .q = -r.rho_q,
          .u = -r.rho_u,
          .i_error = r.absorbed_error,
          .q_error = r.rho_q_error,
          .u_error = r.rho_u_error,
          .terms = std::abs(r.absorbed)};
}

}  // namespace dolp
