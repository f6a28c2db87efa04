#include "radiometry/stokes.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace dolp {
namespace {

using std::numbers::pi;

// Relative rounding error of a radiance. In Planck's law, exp(x) has x times the relative error of x, and x < 710.
constexpr double kRadianceRounding = 1e-12;

/// Contribution of one spectral sample to I, with the emissivity 1 - rho.
struct Intensity {
  double value = 0.0;
  double terms = 0.0;  ///< sum of the magnitudes of the terms of `value`; rounding errors are relative to it
  double error = 0.0;  ///< error of `value` due to the errors of the moments
};

/// I = emitted (1 - rho_I) + incident rho_I = emitted + net rho_I. The form with the smaller terms rounds less.
Intensity moments_intensity(double emitted, double incident, double net, double net_terms, const Reflectance& r) {
  const double split_terms = std::abs(emitted * r.absorbed) + std::abs(incident * r.rho_i);
  const double whole_terms = std::abs(emitted) + net_terms * std::abs(r.rho_i);
  const double difference = std::abs(net);
  if (whole_terms <= split_terms) {
    return {emitted + net * r.rho_i, whole_terms, difference * std::min(r.rho_i_error, r.absorbed_error + r.mismatch)};
  }
  const double apart = std::abs(emitted) * r.absorbed_error + std::abs(incident) * r.rho_i_error;
  const double by_reflected = difference * r.rho_i_error + std::abs(emitted) * r.mismatch;
  const double by_absorbed = difference * r.absorbed_error + std::abs(incident) * r.mismatch;
  return {emitted * r.absorbed + incident * r.rho_i, split_terms, std::min({apart, by_reflected, by_absorbed})};
}

/// The part of rho to which spectral errors of rho_Q are relative. rho_Q is half the difference of rho_s and rho_p, and
/// their errors are relative to the reflected or the absorbed light, whichever is less.
double polarised_terms(const Reflectance& r) {
  return std::max(std::abs(r.rho_q), std::min(std::abs(r.rho_i), std::abs(r.absorbed)));
}

/// Adds one spectral sample, with the emissivity 1 - rho, to `sum`. `rounding`: relative rounding error of each term.
void add_moments_sample(Stokes& sum, const SpectralSample& sample, const Reflectance& r, double direct,
                        double rounding) {
  const double net = direct + sample.excess;
  const double thermal = sample.excess == 0.0 ? 0.0 : std::abs(sample.emitted) + std::abs(sample.surroundings);
  const double net_terms = std::abs(direct) + thermal;
  const Intensity intensity = moments_intensity(sample.emitted, direct + sample.surroundings, net, net_terms, r);
  sum.i += intensity.value;
  sum.q += net * r.rho_q;
  sum.i_error += intensity.error + rounding * intensity.terms;
  sum.q_error += std::abs(net) * r.rho_q_error + rounding * net_terms * polarised_terms(r);
  if (r.rho_u == 0.0) return;  // by symmetry; times a radiance that overflows it would be NaN
  sum.u += net * r.rho_u;
  sum.u_error += std::abs(net) * r.rho_u_error + rounding * net_terms * std::abs(r.rho_u);
}

void add_emitting_sample(Stokes& sum, const SpectralSample& sample, const Reflectance& r, const Emissivity& e,
                         double direct, double rounding) {
  const double incident = direct + sample.surroundings;
  sum.i += sample.emitted * e.i + incident * r.rho_i;
  sum.q += sample.emitted * e.q + incident * r.rho_q;
  const double emitted_terms = std::abs(sample.emitted) * e.terms;
  const double emitted = std::abs(sample.emitted);
  sum.i_error += emitted * e.i_error + std::abs(incident) * r.rho_i_error +
                 rounding * (emitted_terms + std::abs(incident * r.rho_i));
  sum.q_error += emitted * e.q_error + std::abs(incident) * r.rho_q_error +
                 rounding * (emitted_terms + std::abs(incident) * polarised_terms(r));
  if (r.rho_u == 0.0 && e.u == 0.0) return;
  sum.u += sample.emitted * e.u + incident * r.rho_u;
  sum.u_error += emitted * e.u_error + std::abs(incident) * r.rho_u_error +
                 rounding * (std::abs(sample.emitted * e.u) + std::abs(incident * r.rho_u));
}

}  // namespace

Stokes stokes_sum(const SpectralRule& rule, const PerSample<Reflectance>& reflectances,
                  const PerSample<Emissivity>& emissivities, EmissionModel model, double cos_theta, bool with_source) {
  const double rounding = kRadianceRounding + rule.relative_error;
  Stokes sum;
  for (std::size_t j = 0; j < reflectances.size(); ++j) {
    const double direct = with_source ? rule.samples[j].irradiance * cos_theta : 0.0;
    if (model == EmissionModel::kMoments) {
      add_moments_sample(sum, rule.samples[j], reflectances[j], direct, rounding);
    } else {
      add_emitting_sample(sum, rule.samples[j], reflectances[j], emissivities[j], direct, rounding);
    }
  }
  const auto spectral_error = [&](double Reflectance::*rho, double Emissivity::*emissivity) {
    return panel_error(rule, [&](std::size_t j, std::size_t m) {
      const SpectralSample& sample = rule.samples[j];
      const double direct = with_source ? sample.irradiance * cos_theta : 0.0;
      const double reflected = reflectances[m].*rho;
      if (model == EmissionModel::kMoments) return (direct + sample.excess) * reflected;
      return sample.emitted * (emissivities[m].*emissivity) + (direct + sample.surroundings) * reflected;
    });
  };
  sum.i_error += spectral_error(&Reflectance::rho_i, &Emissivity::i);
  sum.q_error += spectral_error(&Reflectance::rho_q, &Emissivity::q);
  if (sum.u_error > 0.0) sum.u_error += spectral_error(&Reflectance::rho_u, &Emissivity::u);
  return sum;
}

void add_specular(Stokes& sum, double net, const Moments& moments) {
  sum.i += net * moments.r_i;
  sum.q += net * moments.r_q;
  sum.i_error += std::abs(net) * (moments.r_i_error + kRadianceRounding * std::abs(moments.r_i));
  sum.q_error += std::abs(net) * (moments.r_q_error + kRadianceRounding * std::abs(moments.r_q));
  if (moments.r_u == 0.0) return;
  sum.u += net * moments.r_u;
  sum.u_error += std::abs(net) * moments.r_q_error;
}

void add_specular_sky(Stokes& sum, double specular, double rounding, const SkyWeights& weights,
                      const Moments& moments) {
  if (specular == 0.0) return;  // the moments may lack the columns of the sky
  assert(weights.of.size() == static_cast<Eigen::Index>(moments.columns.size()));
  double error = weights.error * (std::abs(moments.r_i) + moments.r_i_error);
  double u = 0.0;
  for (std::size_t k = 0; k < moments.columns.size(); ++k) {
    const ColumnMoments& with = moments.columns[k];
    const double weight = weights.of[static_cast<Eigen::Index>(k)];
    sum.i += specular * weight * with.i;
    sum.q += specular * weight * with.q;
    if (with.u != 0.0) u += specular * weight * with.u;
    error += std::abs(weight) * (with.error + rounding * std::abs(moments.r_i));
  }
  sum.i_error += std::abs(specular) * error;
  sum.q_error += std::abs(specular) * error;
  sum.u += u;
  if (u != 0.0) sum.u_error += std::abs(specular) * error;
}

void add_sky(Stokes& sum, const Surface& surface, const SpectralRule& rule, std::span<const SkyWeights> weights,
             const PerSample<DiffuseSample>& diffuse, std::span<const Moments> moments, double cos_theta) {
  const double rounding = kRadianceRounding + rule.relative_error;
  for (std::size_t j = 0; j < weights.size(); ++j) {
    add_specular_sky(sum, surface.specular / cos_theta, rounding, weights[j], moments[j]);
    const DiffuseLight& rho = diffuse[j].rho;
    const Estimate& sky = diffuse[j].beyond_mean;
    const double error = weights[j].error + sky.error + rounding * std::abs(sky.value);
    sum.i += rho.i * sky.value;
    sum.q += rho.q * sky.value;
    sum.i_error += std::abs(rho.i) * error + rho.error * std::abs(sky.value);
    sum.q_error += std::abs(rho.q) * error + rho.error * std::abs(sky.value);
  }
  if (weights.empty() || surface.specular == 0.0) return;
  const auto spectral_error = [&](double ColumnMoments::*part) {
    return panel_error(rule, [&](std::size_t j, std::size_t m) {
      double term = 0.0;
      for (std::size_t k = 0; k < moments[m].columns.size(); ++k)
        term += weights[j].of[static_cast<Eigen::Index>(k)] * (moments[m].columns[k].*part);
      return surface.specular / cos_theta * term;
    });
  };
  sum.i_error += spectral_error(&ColumnMoments::i);
  sum.q_error += spectral_error(&ColumnMoments::q);
  if (sum.u_error > 0.0) sum.u_error += spectral_error(&ColumnMoments::u);
}

void add_beam(Stokes& sum, double k_s, const SpectralRule& rule, std::span<const Scattered> scattered,
              const PerSample<DiffuseLight>& diffuse, double cos_theta_r) {
  const double rounding = kRadianceRounding + rule.relative_error;
  for (std::size_t j = 0; j < scattered.size(); ++j) {
    if (rule.samples[j].irradiance == 0.0) continue;
    const double specular = pi * k_s * rule.samples[j].irradiance / cos_theta_r;
    const double diffuse_i = rule.samples[j].irradiance * diffuse[j].i;
    const double diffuse_q = rule.samples[j].irradiance * diffuse[j].q;
    const double error = std::abs(specular) * (scattered[j].error + rounding * std::abs(scattered[j].i));
    sum.i += specular * scattered[j].i + diffuse_i;
    sum.q += specular * scattered[j].q + diffuse_q;
    sum.u += specular * scattered[j].u;
    sum.v += specular * scattered[j].v;
    sum.i_error += error + rounding * std::abs(diffuse_i);
    sum.q_error += error + rounding * std::abs(diffuse_q);
    sum.u_error += error;
  }
  const auto spectral_error = [&](double Scattered::*part) {
    return panel_error(rule, [&](std::size_t j, std::size_t m) {
      return pi * k_s * rule.samples[j].irradiance / cos_theta_r * (scattered[m].*part);
    });
  };
  sum.i_error += spectral_error(&Scattered::i);
  sum.q_error += spectral_error(&Scattered::q);
  sum.u_error += spectral_error(&Scattered::u);
}

void add_path(Stokes& sum, const std::optional<Path>& path, double path_exitance) {
  if (!path) return;
  for (double* value : {&sum.i, &sum.q, &sum.u, &sum.v, &sum.i_error, &sum.q_error, &sum.u_error}) {
    *value *= path->transmittance;
  }
  sum.i += path_exitance;
  sum.i_error += kRadianceRounding * path_exitance;
}

Bracket bracket(const SceneModel& scene, const SpectralRule& rule, const PerSample<Reflectance>& reflectances,
                const PerSample<Emissivity>& direct, const Stokes& sky, double cos_theta) {
  Stokes single = stokes_sum(rule, reflectances, {}, EmissionModel::kMoments, cos_theta, true);
  single.i += sky.i;
  single.i_error += sky.i_error;
  double q = sky.q;
  // Later bounces give the share D of the light (see Bracket). It is emission, as in `single`, or reflected light.
  double unknown = 0.0;    // if emission: largest change of q
  double unreached = 0.0;  // if reflected light, from an unknown part of the sky: largest change of q and of I
  double reflected = 0.0;  // if reflected light: change of I, for the mean of the sky's least and largest exitance
  double error = sky.q_error;
  for (std::size_t j = 0; j < reflectances.size(); ++j) {
    const SpectralSample& sample = rule.samples[j];
    const double least = sample.sky.size() > 0 ? sample.sky.minCoeff() : 0.0;
    const double most = sample.sky.size() > 0 ? sample.sky.maxCoeff() : 0.0;
    const double middle = 0.5 * (least + most);  // of the sky, beyond its mean
    const double net = sample.irradiance * cos_theta + sample.excess + middle;
    const double rest = std::max(reflectances[j].absorbed - direct[j].i, 0.0);
    q -= net * direct[j].q + middle * reflectances[j].rho_q;
    unknown += std::abs(net) * rest;
    unreached += 0.5 * (most - least) * rest;
    reflected += net * rest;
    error += std::abs(net) * (reflectances[j].absorbed_error + direct[j].i_error + direct[j].q_error) +
             std::abs(middle) * reflectances[j].rho_q_error;
  }
  for (const double Emissivity::*part : {&Emissivity::i, &Emissivity::q}) {
    error += panel_error(rule, [&](std::size_t j, std::size_t m) {
      return (rule.samples[j].irradiance * cos_theta + rule.samples[j].excess) * (direct[m].*part);
    });
  }
  const double transmittance = scene.path ? scene.path->transmittance : 1.0;
  add_path(single, scene.path, rule.path_exitance);
  const double scale = transmittance / single.i;
  Bracket between;
  between.low = scale * std::max(std::abs(q) - unknown, 0.0);
  between.high = scale * (std::abs(q) + unknown);
  if (unreached > 0.0) {
    const double i = single.i + transmittance * reflected;
    const double change = transmittance * unreached;
    between.low = std::min(between.low, transmittance * std::max(std::abs(q) - unreached, 0.0) / (i + change));
    const double least = i - change;
    between.high = std::max(between.high, least > 0.0 ? transmittance * (std::abs(q) + unreached) / least
                                                      : std::numeric_limits<double>::infinity());
  }
  between.error = std::abs(scale) * error + between.high * relative_bound(single.i_error, std::abs(single.i));
  return between;
}

double relative_bound(double error, double value) {
  if (error == 0.0) return 0.0;
  return value > error ? error / (value - error) : std::numeric_limits<double>::infinity();
}

}  // namespace dolp
