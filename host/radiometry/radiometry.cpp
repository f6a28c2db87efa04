#include "radiometry/radiometry.hpp"

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <boost/math/constants/constants.hpp>
#include <cassert>
#include <cmath>
#include <limits>

#include "model/smooth_surface.hpp"
#include "model/status.hpp"

namespace dolp {
namespace {

using boost::math::constants::pi;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRightAngle_deg = 90.0;
// Rounding of the reflectances: fewer than 8 operations on positive terms.
constexpr double kReflectanceRounding = 8.0 * std::numeric_limits<double>::epsilon();
// Rounding of the Stokes sums, each relative to its terms: Planck's exponent, at most 745, times an ulp or two.
constexpr double kRadianceRounding = 1e-12;

/// Reflectance at one index, with bounds of the errors.
struct Reflectance {
  double rho_i = 0.0;
  double rho_q = 0.0;
  double absorbed = 0.0;  ///< 1 - rho_i without cancellation
  double rho_i_error = 0.0;
  double rho_q_error = 0.0;
  double absorbed_error = 0.0;
  double mismatch = 0.0;  ///< |rho_i + absorbed - 1|, which two independently summed moments need not make 0
};

/// Polarised emissivity at one index: that of s is i + q, that of p is i - q.
struct Emissivity {
  double i = 0.0;
  double q = 0.0;
  double i_error = 0.0;
  double q_error = 0.0;
  double terms = 0.0;  ///< sum of the magnitudes that make up either
};

/// Sums over the spectral samples, with bounds of their errors.
struct Stokes {
  double i = 0.0;
  double q = 0.0;
  double i_error = 0.0;
  double q_error = 0.0;
  double u = 0.0;
  double v = 0.0;
  double u_error = 0.0;
};

/// Adds a specular term `net` * r, with cos(theta) in r.
void add_specular(Stokes& sum, double net, const Moments& moments) {
  sum.i += net * moments.r_i;
  sum.q += net * moments.r_q;
  sum.i_error += std::abs(net) * (moments.r_i_error + kRadianceRounding * std::abs(moments.r_i));
  sum.q_error += std::abs(net) * (moments.r_q_error + kRadianceRounding * std::abs(moments.r_q));
}

/// rho over the spectral samples.
struct MeanReflectance {
  double rho_i = 0.0;
  double rho_q = 0.0;
  double error = 0.0;  ///< of the worse of the two
};

EmissionModel emission_model(const Scene& scene) {
  return scene.emission ? scene.emission->model : EmissionModel::kMoments;
}

double diffuse_reflectance(const Surface& surface, double cos_theta) {
  if (surface.diffuse == 0.0) return 0.0;
  const double c = surface.diffuse_exponent;
  return 2.0 * surface.diffuse * std::pow(cos_theta, c) / (c + 2.0);
}

// 1 - rho comes from the deficit, never from 1 - rho, which would lose the digits of a metal's emission.
Reflectance reflectance(const Surface& surface, const Moments& moments, double cos_theta) {
  const double scale = surface.specular / cos_theta;
  const double diffuse = diffuse_reflectance(surface, cos_theta);
  const double absorbed_terms = (1.0 - surface.specular) + scale * std::abs(moments.deficit) + diffuse;
  Reflectance r;
  r.rho_i = scale * moments.r_i + diffuse;
  r.rho_q = scale * moments.r_q;
  r.absorbed = (1.0 - surface.specular) + scale * moments.deficit - diffuse;
  r.rho_i_error = scale * moments.r_i_error + kReflectanceRounding * std::abs(r.rho_i);
  r.rho_q_error = scale * moments.r_q_error + kReflectanceRounding * std::abs(r.rho_q);
  r.absorbed_error = scale * moments.deficit_error + kReflectanceRounding * absorbed_terms;
  r.mismatch = scale * std::abs((moments.r_i - cos_theta) + moments.deficit);
  return r;
}

Emissivity fresnel_emissivity(const OpticalConstants& index, double cos_theta) {
  const SmoothAbsorptance absorptance = smooth_absorptance(index, cos_theta);
  const double mean = 0.5 * (absorptance.s + absorptance.p);
  return {.i = mean, .q = 0.5 * (absorptance.s - absorptance.p), .terms = mean};
}

/// Equation: eps_I = k_s eps_I,direct + 1 - k_s - diffuse, eps_Q = k_s eps_Q,direct.
Emissivity direct_emissivity(const Surface& surface, const Moments& m, double cos_theta) {
  const double scale = surface.specular / cos_theta;
  const double rest = 1.0 - surface.specular;
  const double diffuse = diffuse_reflectance(surface, cos_theta);
  return {.i = scale * m.direct_i + rest - diffuse,
          .q = scale * m.direct_q,
          .i_error = scale * m.direct_i_error,
          .q_error = scale * m.direct_q_error,
          .terms = scale * std::abs(m.direct_i) + rest + diffuse};
}

Emissivity kirchhoff_emissivity(const Reflectance& r) {
  return {.i = r.absorbed,
          .q = -r.rho_q,
          .i_error = r.absorbed_error,
          .q_error = r.rho_q_error,
          .terms = std::abs(r.absorbed)};
}

/// What one sample adds to I under the moments' own emission.
struct Intensity {
  double value = 0.0;
  double terms = 0.0;  ///< sum of the magnitudes that were added, to which rounding is relative
  double error = 0.0;  ///< from the errors of the moments
};

/// Equation: I = pi B (1 - rho_I) + X rho_I = pi B + (X - pi B) rho_I, whichever adds the smaller terms: the first
/// keeps the digits of a metal, the second those of a reflectance far above 1 and of equal temperatures. The moments
/// r_i and deficit err together if they err at all, so either may stand for the other at the price of their mismatch.
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

/// One sample's part of the Stokes sums with Kirchhoff's emission; `rounding` is relative to each term.
void add_moments_sample(Stokes& sum, const SpectralSample& sample, const Reflectance& r, double direct,
                        double rounding) {
  const double net = direct + sample.excess;
  // Equal temperatures cancel exactly: then the excess has no rounding either.
  const double thermal = sample.excess == 0.0 ? 0.0 : std::abs(sample.emitted) + std::abs(sample.surroundings);
  const double net_terms = std::abs(direct) + thermal;
  const Intensity intensity = moments_intensity(sample.emitted, direct + sample.surroundings, net, net_terms, r);
  sum.i += intensity.value;
  sum.q += net * r.rho_q;
  sum.i_error += intensity.error + rounding * intensity.terms;
  sum.q_error += std::abs(net) * r.rho_q_error + rounding * net_terms * std::abs(r.rho_q);
}

/// The same with an emission that is not 1 - rho.
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
                 rounding * (emitted_terms + std::abs(incident * r.rho_q));
}

void add_path(Stokes& sum, const std::optional<Path>& path, double path_exitance) {
  if (!path) return;
  for (double* value : {&sum.i, &sum.q, &sum.u, &sum.v, &sum.i_error, &sum.q_error, &sum.u_error}) {
    *value *= path->transmittance;
  }
  sum.i += path_exitance;
  sum.i_error += kRadianceRounding * path_exitance;
}

/// Exitances by emission and by reflection of the surroundings and, `with_source`, of the source into the hemisphere.
Stokes stokes_sum(const SpectralRule& rule, std::span<const Reflectance> reflectances,
                  std::span<const Emissivity> emissivities, EmissionModel model, double cos_theta, bool with_source) {
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
  return sum;
}

double relative_bound(double error, double value) {
  if (error == 0.0) return 0.0;
  return value > error ? error / (value - error) : kInfinity;
}

/// What DOLP lies between of a surface with these facets and all its bounces.
///
/// Equation: its eps_I is larger than the direct one by d <= D = 1 - rho_I - eps_I,direct, which changes eps_Q by d at
/// most; I = X + N eps_I, Q = N eps_Q with N = pi B - X, X the exitances of source and surroundings. Both ends lie at d
/// = D, where I is that of single scattering: (|sum N eps_Q,direct| -+ sum |N| D) / I.
struct Bracket {
  double low = 0.0;
  double high = 0.0;
  double error = 0.0;
};

Bracket bracket(const Scene& scene, const SpectralRule& rule, std::span<const Reflectance> reflectances,
                std::span<const Emissivity> direct, double cos_theta) {
  Stokes single = stokes_sum(rule, reflectances, {}, EmissionModel::kMoments, cos_theta, true);
  double q = 0.0;
  double slack = 0.0;
  double error = 0.0;
  for (std::size_t j = 0; j < reflectances.size(); ++j) {
    const SpectralSample& sample = rule.samples[j];
    const double net = sample.irradiance * cos_theta + sample.excess;
    q -= net * direct[j].q;
    slack += std::abs(net) * std::max(reflectances[j].absorbed - direct[j].i, 0.0);
    error += std::abs(net) * (reflectances[j].absorbed_error + direct[j].i_error + direct[j].q_error);
  }
  const double transmittance = scene.path ? scene.path->transmittance : 1.0;
  add_path(single, scene.path, rule.path_exitance);
  const double scale = transmittance / single.i;
  Bracket between;
  between.low = scale * std::max(std::abs(q) - slack, 0.0);
  between.high = scale * (std::abs(q) + slack);
  between.error = std::abs(scale) * error + between.high * relative_bound(single.i_error, std::abs(single.i));
  return between;
}

/// Adds pi E0 cos(theta_i) f of the beam from the source, the factor pi as in the exitances of the sum.
void add_beam(Stokes& sum, const Surface& surface, double k_s, const SpectralRule& rule,
              std::span<const Scattered> scattered, double cos_theta_i, double cos_theta_r) {
  const double diffuse = surface.diffuse == 0.0
                             ? 0.0
                             : surface.diffuse * std::pow(cos_theta_i, surface.diffuse_exponent + 1.0) *
                                   std::pow(cos_theta_r, surface.diffuse_exponent);
  const double rounding = kRadianceRounding + rule.relative_error;
  for (std::size_t j = 0; j < scattered.size(); ++j) {
    if (rule.samples[j].irradiance == 0.0) continue;
    const double specular = pi<double>() * k_s * rule.samples[j].irradiance / cos_theta_r;
    const double unpolarised = rule.samples[j].irradiance * diffuse;
    const double error = std::abs(specular) * (scattered[j].error + rounding * std::abs(scattered[j].i));
    sum.i += specular * scattered[j].i + unpolarised;
    sum.q += specular * scattered[j].q;
    sum.u += specular * scattered[j].u;
    sum.v += specular * scattered[j].v;
    sum.i_error += error + rounding * std::abs(unpolarised);
    sum.q_error += error;
    sum.u_error += error;
  }
}

void set_dolp(PointResult& result, const Stokes& sum) {
  result.dolp = std::hypot(sum.q, sum.u) / sum.i;
  const double i = std::abs(sum.i);
  const double margin = i - sum.i_error;
  if (std::isnan(result.dolp)) {
    result.error_estimate = kNan;
  } else if (margin > 0.0) {
    result.error_estimate = (std::hypot(sum.q_error, sum.u_error) + std::abs(result.dolp) * sum.i_error) / margin;
  } else {
    result.error_estimate = kInfinity;
  }
}

/// Whether rho_s or rho_p is outside [0, 1] beyond doubt.
bool is_unphysical(const Reflectance& r) {
  const double q = std::abs(r.rho_q);
  const double above = std::max(q - r.absorbed - r.absorbed_error, r.rho_i + q - 1.0 - r.rho_i_error);
  const double below = q - r.rho_i - r.rho_i_error;
  return std::max(above, below) > r.rho_q_error + kReflectanceRounding;
}

void add_emissivity(PointResult& result, const SpectralRule& rule, std::span<const Emissivity> emissivities) {
  double total = 0.0;
  double i = 0.0;
  double q = 0.0;
  for (std::size_t j = 0; j < emissivities.size(); ++j) {
    const double weight = rule.samples[j].emitted;
    total += weight;
    i += weight * emissivities[j].i;
    q += weight * emissivities[j].q;
  }
  result.emissivity_s = (i + q) / total;
  result.emissivity_p = (i - q) / total;
}

std::uint32_t tolerance_status(const PointResult& result, double tolerance) {
  const bool is_outside = (result.status & kStatusOutsideDomain) != 0;  // rho diverges; the DOLP is a limit, or NaN
  const bool dolp_missed = (is_outside || promises_dolp(result.status)) && result.error_estimate > tolerance;
  const bool rho_missed = !is_outside && result.rho_error_estimate > tolerance;
  return dolp_missed || rho_missed ? kStatusToleranceMissed : 0;
}

PointResult outside_domain() {
  PointResult result;
  result.dolp = result.stokes_i = result.stokes_q = result.stokes_u = result.stokes_v = kNan;
  result.rho_i = result.rho_q = result.albedo = result.error_estimate = result.rho_error_estimate = kNan;
  result.status = kStatusOutsideDomain;
  return result;
}

bool is_known(const Moments& moments) {
  return !std::isnan(moments.r_i) && !std::isnan(moments.r_q) && !std::isnan(moments.deficit);
}

bool specular_diverges(const Surface& surface) {
  return surface.masking == Masking::kNone || surface.masking == Masking::kIntegral;
}

bool diffuse_diverges(const Surface& surface) { return surface.diffuse > 0.0 && surface.diffuse_exponent < 0.0; }

// A specular part that stays below 2 next to a vanishing cosine is that of a mirror or of n = 1: it has a limit.
bool reflectance_diverges(const Surface& surface, const Direction& direction, std::span<const Moments> moments) {
  if (direction.theta_deg != kRightAngle_deg) return false;
  if (direction.cos_theta == 0.0 || diffuse_diverges(surface)) return true;
  return specular_diverges(surface) && std::ranges::any_of(moments, [&](const Moments& m) {
           return surface.specular * m.r_i > 2.0 * direction.cos_theta;
         });
}

/// The weight of a sample in the mean reflectance, from the kind of radiation the scene has.
double mean_weight(const SpectralSample& sample, double total_emitted, double total_incident, double cos_theta) {
  if (total_emitted != 0.0) return sample.emitted;
  if (total_incident != 0.0) return sample.irradiance * cos_theta + sample.surroundings;
  return sample.width;
}

MeanReflectance mean_reflectance(const SpectralRule& rule, std::span<const Reflectance> reflectances,
                                 double cos_theta) {
  double emitted = 0.0;
  double incident = 0.0;
  for (const SpectralSample& sample : rule.samples) {
    emitted += sample.emitted;
    incident += sample.irradiance * cos_theta + sample.surroundings;
  }
  MeanReflectance mean;
  double total = 0.0;
  double rho_i_error = 0.0;
  double rho_q_error = 0.0;
  for (std::size_t j = 0; j < reflectances.size(); ++j) {
    const Reflectance& r = reflectances[j];
    const double weight = mean_weight(rule.samples[j], emitted, incident, cos_theta);
    total += weight;
    mean.rho_i += weight * r.rho_i;
    mean.rho_q += weight * r.rho_q;
    rho_i_error += std::abs(weight) * (r.rho_i_error + rule.relative_error * std::abs(r.rho_i));
    rho_q_error += std::abs(weight) * (r.rho_q_error + rule.relative_error * std::abs(r.rho_q));
  }
  mean.rho_i /= total;
  mean.rho_q /= total;
  mean.error = std::max(rho_i_error, rho_q_error) / total;
  return mean;
}

/// Equation: the terms of I and Q that grow fastest as cos(theta) -> 0, times whatever makes them finite: D r with D
/// the surroundings without what the moments take off the emission; with D = 0 pi B + E0 r_i and E0 r_q, and the path.
/// The fresnel emission vanishes there.
Stokes grazing_stokes(const Scene& scene, const SpectralRule& rule, std::span<const Moments> moments) {
  const Surface& surface = scene.surface;
  const bool fresnel = emission_model(scene) == EmissionModel::kFresnel;
  const double emissivity = fresnel ? 0.0 : 1.0;
  Stokes leading;
  Stokes finite;
  for (std::size_t j = 0; j < moments.size(); ++j) {
    const SpectralSample& sample = rule.samples[j];
    add_specular(leading, surface.specular * (fresnel ? sample.surroundings : sample.excess), moments[j]);
    add_specular(finite, surface.specular * sample.irradiance, moments[j]);
    finite.i += sample.emitted * emissivity;
  }
  if (leading.i != 0.0 || leading.q != 0.0) return leading;
  add_path(finite, scene.path, rule.path_exitance);
  return finite;
}

bool is_isothermal(const SpectralRule& rule) {
  return std::ranges::all_of(rule.samples, [](const SpectralSample& sample) { return sample.excess == 0.0; });
}

/// Result at 90 degrees where rho diverges.
PointResult grazing_limit(const Scene& scene, const SpectralRule& rule, const Direction& direction,
                          std::span<const Moments> moments) {
  const Surface& surface = scene.surface;
  PointResult result = outside_domain();
  result.status = kStatusUnphysicalReflectance | kStatusOutsideDomain;
  result.rho_error_estimate = 0.0;
  if (!specular_diverges(surface)) {
    if (direction.cos_theta > 0.0) result.albedo = moments.front().albedo / direction.cos_theta;
    // A diverging diffuse part is unpolarised. Only next to a fresnel emission of the same temperature does it cancel,
    // and what would be left then is not worth a formula of its own.
    const bool cancels = emission_model(scene) == EmissionModel::kFresnel && is_isothermal(rule);
    if (diffuse_diverges(surface) && !cancels) result.dolp = result.error_estimate = 0.0;
    return result;
  }
  for (const Moments& m : moments) {
    const double bound = surface.specular == 0.0 ? 0.0 : relative_bound(std::max(m.r_i_error, m.r_q_error), m.r_i);
    result.rho_error_estimate = std::max(result.rho_error_estimate, bound);
  }
  set_dolp(result, grazing_stokes(scene, rule, moments));
  result.dolp = std::abs(result.dolp);
  return result;
}

}  // namespace

Radiometry::Radiometry(const Scene& scene, const KeptEffects& kept, const DropBound& dropped)
    : scene_(scene),
      beam_specular_(scene.surface.specular),
      kept_(kept),
      dropped_(dropped),
      knows_rho_(kept.moments || scene.surface.specular == 0.0),
      rule_(spectral_rule(scene)),
      kept_rule_(kept_rule(rule_, kept)),
      indices_(rule_.indices()) {
  if (!kept.moments) scene_.surface.specular = 0.0;
  if (!kept.diffuse) scene_.surface.diffuse = 0.0;
}

PointResult Radiometry::finished(PointResult result) const {
  if (!kept_.moments) result.albedo = kNan;
  if (!knows_rho_ && emission_model(scene_) != EmissionModel::kFresnel)
    result.emissivity_s = result.emissivity_p = kNan;
  if (!knows_rho_) result.rho_i = result.rho_q = result.rho_error_estimate = kNan;
  result.error_estimate += dropped_.dolp;
  result.rho_error_estimate += dropped_.rho;
  result.status |= tolerance_status(result, scene_.accuracy.tolerance);
  return result;
}

PointResult Radiometry::point(const Direction& direction, std::span<const Moments> moments) const {
  return point(direction, moments, indices_);
}

PointResult Radiometry::point(const Direction& direction, std::span<const Moments> moments,
                              std::span<const OpticalConstants> indices) const {
  assert(moments.size() == rule_.samples.size() && indices.size() == moments.size());
  if (!std::ranges::all_of(moments, is_known)) return outside_domain();
  if (reflectance_diverges(scene_.surface, direction, moments)) {
    return finished(grazing_limit(scene_, kept_rule_, direction, moments));
  }
  return finished(assemble(moments, direction.cos_theta, indices, direction.cos_theta, {}));
}

PointResult Radiometry::bistatic_point(const Direction& view, double cos_theta_i, std::span<const Moments> moments,
                                       std::span<const OpticalConstants> indices,
                                       std::span<const Scattered> scattered) const {
  assert(moments.size() == rule_.samples.size() && scattered.size() == moments.size());
  if (!std::ranges::all_of(moments, is_known)) return outside_domain();
  if (reflectance_diverges(scene_.surface, view, moments)) {
    PointResult result = outside_domain();
    result.status |= kStatusUnphysicalReflectance;
    return result;
  }
  return finished(assemble(moments, view.cos_theta, indices, cos_theta_i, scattered));
}

PointResult Radiometry::assemble(std::span<const Moments> moments, double cos_theta,
                                 std::span<const OpticalConstants> indices, double cos_theta_i,
                                 std::span<const Scattered> scattered) const {
  const bool bistatic = scene_.geometry.mode == Mode::kBistatic;
  PointResult result;
  boost::container::small_vector<Reflectance, 1> own;  // most scenes have one sample, and many entries
  for (const Moments& m : moments) {
    own.push_back(reflectance(scene_.surface, m, cos_theta));
    if (is_unphysical(own.back())) result.status |= kStatusUnphysicalReflectance;
  }
  const std::span<const Reflectance> reflectances(own.data(), own.size());
  const EmissionModel model = emission_model(scene_);
  const auto emissivities_of = [&](EmissionModel of) {
    boost::container::small_vector<Emissivity, 1> list;
    for (std::size_t j = 0; j < moments.size(); ++j) {
      list.push_back(of == EmissionModel::kFresnel  ? fresnel_emissivity(indices[j], cos_theta)
                     : of == EmissionModel::kDirect ? direct_emissivity(scene_.surface, moments[j], cos_theta)
                                                    : kirchhoff_emissivity(own[j]));
    }
    return list;
  };
  const auto list = emissivities_of(model);
  const std::span<const Emissivity> emissivities(list.data(), list.size());
  Stokes sum = stokes_sum(kept_rule_, reflectances, emissivities, model, cos_theta, !bistatic);
  if (bistatic) add_beam(sum, scene_.surface, beam_specular_, kept_rule_, scattered, cos_theta_i, cos_theta);
  add_path(sum, scene_.path, kept_rule_.path_exitance);
  const double unit = bistatic ? 1.0 / pi<double>() : 1.0;  // an exitance, or the radiance that it is the integral of
  const MeanReflectance mean = mean_reflectance(rule_, reflectances, cos_theta);
  result.stokes_i = unit * sum.i;
  result.stokes_q = unit * sum.q + 0.0;  // without the sign of a zero
  result.stokes_u = unit * sum.u + 0.0;
  result.stokes_v = unit * sum.v + 0.0;
  result.rho_i = mean.rho_i;
  result.rho_q = mean.rho_q;
  result.albedo = moments.front().albedo / cos_theta;
  result.rho_error_estimate = relative_bound(mean.error, mean.rho_i);
  set_dolp(result, sum);
  if (scene_.emission) add_emissivity(result, rule_, emissivities);
  if (scene_.emission && scene_.emission->has_bracket) {
    const auto direct = emissivities_of(EmissionModel::kDirect);
    const Bracket between = bracket(scene_, kept_rule_, reflectances, {direct.data(), direct.size()}, cos_theta);
    result.dolp_low = between.low;
    result.dolp_high = between.high;
    result.error_estimate = std::max(result.error_estimate, between.error);
  }
  if (sum.i <= 0.0) result.status |= kStatusNonPositiveIntensity;
  if (std::isnan(result.dolp)) result.status |= kStatusOutsideDomain;
  return result;
}

}  // namespace dolp
