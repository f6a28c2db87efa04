#include "radiometry/radiometry.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include <dolp/status.hpp>
#include "base/numbers.hpp"
#include "radiometry/reflectance.hpp"
#include "radiometry/stokes.hpp"

namespace dolp {
namespace {

using std::numbers::pi;

constexpr double kRightAngle_deg = 90.0;
constexpr std::size_t kMostGroups = 8;
constexpr double kNegligibleDolpChange = 1e-4;  // may_change_dolp() is false below it

using enum Quantity;

EmissionModel emission_model(const SceneModel& scene) {
  return scene.emission ? scene.emission->model : EmissionModel::kMoments;
}

void set_dolp(PointResult& result, const Stokes& sum) {
  result[kDolp] = polarised_part(sum.q, sum.u) / sum.i;
  result[kQOverI] = sum.q / sum.i + 0.0;  // adding 0 turns -0 into 0
  result[kAolp] = polarisation_angle_deg(sum.q, sum.u);
  const double i = std::abs(sum.i);
  const double margin = i - sum.i_error;
  if (std::isnan(result[kDolp])) {
    result[kErrorEstimate] = kNan;
  } else if (margin > 0.0 && !std::isnan(sum.q_error) && !std::isnan(sum.u_error)) {
    result[kErrorEstimate] =
        (polarised_part(sum.q_error, sum.u_error) + std::abs(result[kDolp]) * sum.i_error) / margin;
  } else {
    result[kErrorEstimate] = kInfinity;
  }
}

void add_emissivity(PointResult& result, const PerSample<Emissivity>& emissivities, const MeanWeights& weights) {
  double i = 0.0;
  double q = 0.0;
  for (std::size_t j = 0; j < emissivities.size(); ++j) {
    i += weights.list[j] * emissivities[j].i;
    q += weights.list[j] * emissivities[j].q;
  }
  result[kEmissivityS] = (i + q) / weights.total;
  result[kEmissivityP] = (i - q) / weights.total;
}

std::uint32_t tolerance_status(const PointResult& result, double tolerance) {
  const bool is_outside = (result.status & kOutsideModelDomain) != 0;  // rho diverges, or DOLP is NaN
  const bool dolp_missed = (is_outside || promises_dolp(result.status)) && result[kErrorEstimate] > tolerance;
  const bool rho_missed = !std::isnan(result[kRhoI]) && result[kRhoErrorEstimate] > tolerance;
  return (dolp_missed ? std::uint32_t{kToleranceNotMet} : 0U) | (rho_missed ? std::uint32_t{kRhoToleranceNotMet} : 0U);
}

/// Estimates how much light single scattering leaves out of I because it ignores later bounces. With direct emission
/// this is pi B (1 - rho_I - eps_I). Otherwise it is the change of I if the specular part of rho_I is divided by the
/// albedo A. A is rho_I of facets that reflect all light. With all bounces A would be 1.
double change_by_model(const SceneModel& scene, const SpectralRule& rule, std::span<const Moments> moments,
                       const PerSample<Reflectance>& reflectances, const PerSample<Emissivity>& emissivities,
                       double cos_theta) {
  const Surface& surface = scene.surface;
  if (surface.scattering == Scattering::kMultiple || surface.specular == 0.0) return 0.0;
  const EmissionModel model = emission_model(scene);
  const double source = scene.geometry.mode == Mode::kHemispherical ? 1.0 : 0.0;
  double change = 0.0;
  for (std::size_t j = 0; j < moments.size(); ++j) {
    const SpectralSample& sample = rule.samples[j];
    const Moments& m = moments[j];
    if (model == EmissionModel::kDirect) {
      change += sample.emitted * (reflectances[j].absorbed - emissivities[j].i);
      continue;
    }
    const double mean_reflectance = m.albedo > 0.0 ? m.r_i / m.albedo : 1.0;
    const double lost = surface.specular * mean_reflectance * (1.0 - m.albedo / cos_theta);
    const double emission = model == EmissionModel::kFresnel ? sample.surroundings : sample.excess;
    change += lost * (emission + source * sample.irradiance * cos_theta);
  }
  return std::abs(change) * (scene.path ? scene.path->transmittance : 1.0);
}

PointResult outside_domain() {
  PointResult result;
  result.status = kOutsideModelDomain;
  return result;
}

/// The result if an evaluator found no number. Its status makes the run compute the entry again with more accuracy.
PointResult not_computed() {
  PointResult result;
  result[kErrorEstimate] = result[kRhoErrorEstimate] = kInfinity;
  result.status = kToleranceNotMet | kRhoToleranceNotMet;
  return result;
}

bool is_known(const Moments& moments, bool with_direct) {
  const double sum = moments.r_i + moments.r_q + moments.deficit + moments.r_u;
  if (std::isnan(with_direct ? sum + moments.direct_i + moments.direct_q + moments.direct_u : sum)) return false;
  return std::ranges::none_of(moments.columns, [](const ColumnMoments& c) { return std::isnan(c.i + c.q + c.u); });
}

bool reflectance_diverges(const Surface& surface, const Direction& direction, std::span<const Moments> moments) {
  if (direction.theta_deg != kRightAngle_deg) return false;
  if (direction.cos_theta == 0.0 || diffuse_diverges(surface)) return true;
  return !keeps_projected_area(surface.masking) && std::ranges::any_of(moments, [&](const Moments& m) {
    return surface.specular * m.r_i > 2.0 * direction.cos_theta;
  });
}

/// The terms of I and Q that dominate as theta -> 90 degrees, times a common factor, which cancels in DOLP.
Stokes grazing_stokes(const SceneModel& scene, const SpectralRule& rule, std::span<const SkyWeights> sky,
                      std::span<const Moments> moments) {
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
    if (!sky.empty()) add_specular_sky(leading, surface.specular, rule.relative_error, sky[j], moments[j]);
  }
  if (leading.i != 0.0 || leading.q != 0.0) return leading;
  add_path(finite, scene.path, rule.path_exitance);
  return finite;
}

bool is_isothermal(const SpectralRule& rule) {
  return std::ranges::all_of(
      rule.samples, [](const SpectralSample& sample) { return sample.excess == 0.0 && sample.sky.size() == 0; });
}

PointResult grazing_limit(const SceneModel& scene, const SpectralRule& rule, std::span<const SkyWeights> sky,
                          const Direction& direction, std::span<const Moments> moments) {
  const Surface& surface = scene.surface;
  PointResult result = outside_domain();
  result.status = kReflectanceOutsideZeroToOne | kOutsideModelDomain;
  result[kRhoErrorEstimate] = 0.0;
  if (keeps_projected_area(surface.masking)) {
    if (direction.cos_theta > 0.0) result[kAlbedo] = moments.front().albedo / direction.cos_theta;
    // The diverging diffuse light is unpolarised, so DOLP is 0. In isothermal scenes with fresnel emission it is NaN.
    const bool cancels = emission_model(scene) == EmissionModel::kFresnel && is_isothermal(rule);
    if (diffuse_diverges(surface) && !cancels) result[kDolp] = result[kQOverI] = result[kErrorEstimate] = 0.0;
    return result;
  }
  for (const Moments& m : moments) {
    const double bound = surface.specular == 0.0 ? 0.0 : relative_bound(std::max(m.r_i_error, m.r_q_error), m.r_i);
    result[kRhoErrorEstimate] = std::max(result[kRhoErrorEstimate], bound);
  }
  set_dolp(result, grazing_stokes(scene, rule, sky, moments));
  result[kDolp] = std::abs(result[kDolp]);
  return result;
}

double dolp_with(const PointResult& result, double more_i, double more_q) {
  const double i = result[kStokesI] + more_i;
  const double q = result[kStokesQ] + more_q;
  const double u = result[kStokesU];
  return i > 0.0 ? std::min(polarised_part(q, u) / i, 1.0) : 1.0;
}

}  // namespace

double polarisation_angle_deg(double q, double u) {
  if (u == 0.0 && !(std::abs(q) > 0.0)) return kNan;
  if (u == 0.0) return q > 0.0 ? 0.0 : kRightAngle_deg;
  const double angle_deg = 90.0 / pi * std::atan2(u, q);
  const double positive_deg = angle_deg < 0.0 ? angle_deg + 180.0 : angle_deg;
  return positive_deg == 180.0 ? 0.0 : positive_deg;  // a tiny negative angle is rounded to 180
}

std::vector<std::size_t> middle_samples(std::size_t samples) {
  const std::size_t groups = std::min(samples, kMostGroups);
  std::vector<std::size_t> middles;
  for (std::size_t i = 0; i < groups; ++i) middles.push_back((2 * i + 1) * samples / (2 * groups));
  return middles;
}

Radiometry::Radiometry(const SceneModel& scene, SpectralRule rule, const RadiometrySettings& settings)
    : scene_(scene),
      beam_specular_(scene.surface.specular),
      settings_(settings),
      knows_rho_(scene.surface.specular == 0.0 || (settings.kept.moments && !scene.surface.has_only_direct())),
      knows_emissivity_(knows_rho_ || emission_model(scene) == EmissionModel::kFresnel ||
                        (settings.kept.moments && emission_model(scene) == EmissionModel::kDirect)),
      rule_(std::move(rule)),
      kept_rule_(kept_rule(rule_, settings.kept)) {
  const KeptEffects& kept = settings.kept;
  if (!kept.moments) scene_.surface.specular = 0.0;
  if (!kept.diffuse) rule_.diffuse.reset();
  if (rule_.diffuse) scene_.surface.diffuse = rule_.diffuse->mean;
  if (!kept.diffuse) scene_.surface.diffuse = 0.0;
  if (!kept.emission && emission_model(scene) == EmissionModel::kDirect) {
    scene_.emission->model = EmissionModel::kMoments;  // the moments lack the direct emission
    knows_emissivity_ = false;
  }
  uses_direct_ = scene_.surface.specular > 0.0 && scene_.emission &&
                 (scene_.emission->has_bracket || emission_model(scene_) == EmissionModel::kDirect);
  if (kept.surroundings && kept.profile)
    basis_ = settings.sky ? settings.sky : sky_basis(scene, std::array<const SpectralRule*, 1>{&rule_});
  sky_ = sky_weights(kept_rule_, basis_.get());
  nets_.resize(middle_samples(kept_rule_.samples.size()).size());
  for (std::size_t j = 0; j < kept_rule_.samples.size(); ++j) {
    const SpectralSample& sample = kept_rule_.samples[j];
    Net& net = nets_[j * nets_.size() / kept_rule_.samples.size()];
    net.thermal += emission_model(scene) == EmissionModel::kFresnel ? sample.surroundings : sample.excess;
    net.source += scene.geometry.mode == Mode::kHemispherical ? sample.irradiance : 0.0;
    emitted_ += sample.emitted;
  }
  scale_ = scene.path ? scene.path->transmittance : 1.0;
  if (scene.geometry.mode == Mode::kBistatic) scale_ /= pi;
  optics_ = optics_with(rule_.indices());
}

Radiometry::Optics Radiometry::optics_with(std::vector<FacetOptics> facets) const {
  Optics optics;
  for (const FacetOptics& facet : facets) optics.diffuse.emplace_back(scene_.surface, facet, settings_.transmission);
  for (std::size_t j = 0; scene_.surface.diffuse > 0.0 && j < sky_.size(); ++j)
    optics.diffuse_beyond_mean.push_back(optics.diffuse[j].sky_mean(basis_->nodes(), kept_rule_.samples[j].sky));
  optics.facets = std::move(facets);
  return optics;
}

PointResult Radiometry::finished(PointResult result) const {
  if (!settings_.kept.moments || scene_.surface.has_only_direct()) result[kAlbedo] = kNan;
  if (!knows_emissivity_) result[kEmissivityS] = result[kEmissivityP] = kNan;
  if (!knows_rho_) result[kRhoI] = result[kRhoQ] = result[kRhoU] = result[kRhoErrorEstimate] = kNan;
  result[kErrorEstimate] += settings_.dropped;
  result.status |= tolerance_status(result, scene_.accuracy.tolerance);
  return result;
}

Radiometry::View Radiometry::view(const Direction& direction, const Optics& optics, double cos_theta_i) const {
  const bool bistatic = scene_.geometry.mode == Mode::kBistatic;
  View view{direction, bistatic ? cos_theta_i : direction.cos_theta, mean_weights(rule_, direction.cos_theta)};
  for (std::size_t j = 0; j < optics.facets.size(); ++j) {
    view.diffuse.push_back({optics.diffuse[j].rho(direction.cos_theta),
                            optics.diffuse_beyond_mean.empty() ? Estimate{} : optics.diffuse_beyond_mean[j]});
    if (bistatic) view.diffuse_beam.push_back(optics.diffuse[j].beam(cos_theta_i, direction.cos_theta));
    if (emission_model(scene_) == EmissionModel::kFresnel)
      view.fresnel.push_back(fresnel_emissivity(optics.facets[j], direction.cos_theta));
  }
  return view;
}

PointResult Radiometry::point(const View& view, std::span<const Moments> moments,
                              std::span<const Scattered> scattered) const {
  assert(moments.size() == rule_.samples.size() && view.diffuse.size() == moments.size());
  const Direction& direction = view.direction;
  if (!std::ranges::all_of(moments, [&](const Moments& m) { return is_known(m, uses_direct_); }))
    return direction.treatment == Treatment::kDivergentLimit ? outside_domain() : not_computed();
  if (!reflectance_diverges(scene_.surface, direction, moments)) return finished(assemble(view, moments, scattered));
  const bool has_beam =
      scene_.geometry.mode == Mode::kBistatic &&
      std::ranges::any_of(rule_.samples, [](const SpectralSample& sample) { return sample.irradiance != 0.0; });
  if (!has_beam) return finished(grazing_limit(scene_, kept_rule_, sky_, direction, moments));
  PointResult result = outside_domain();
  result.status |= kReflectanceOutsideZeroToOne;
  return result;
}

bool Radiometry::may_change_dolp(const PointResult& result, double cos_theta) const {
  const bool is_mirror = result[kAlbedo] == 1.0;  // its light meets no second facet
  const bool is_judged = scene_.surface.scattering == Scattering::kSingle && scene_.surface.specular > 0.0;
  if (!is_judged || is_mirror || !promises_dolp(result.status) || std::isnan(result[kAlbedo])) return false;
  if (emission_model(scene_) == EmissionModel::kDirect) return true;
  double most = 0.0;
  for (const Net& net : nets_) most += std::abs(net.thermal + cos_theta * net.source);
  most *= scale_ * scene_.surface.specular * std::abs(1.0 - result[kAlbedo]);
  return most * (1.0 + result[kDolp]) > kNegligibleDolpChange * (result[kStokesI] - most);
}

void Radiometry::judge_dolp(PointResult& result, double cos_theta, std::span<const FurtherLight> further) const {
  const double lost = scene_.surface.specular * (1.0 - result[kAlbedo]);
  double i = 0.0;
  double q = 0.0;
  for (std::size_t j = 0; j < nets_.size(); ++j) {
    const FurtherLight& light = further[std::min(j, further.size() - 1)];
    const double net = lost * (nets_[j].thermal + cos_theta * nets_[j].source);
    i += net * light.i;
    q += net * light.q;
  }
  if (emission_model(scene_) == EmissionModel::kDirect) {  // such a surface emits less than it absorbs
    i += emitted_ * (1.0 - result[kRhoI] - 0.5 * (result[kEmissivityS] + result[kEmissivityP]));
    q -= emitted_ * (result[kRhoQ] + 0.5 * (result[kEmissivityS] - result[kEmissivityP]));
  }
  result.model_change_dolp = std::abs(dolp_with(result, scale_ * i, scale_ * q) - result[kDolp]);
  const double allowed = std::max(kLargestModelChange * result[kDolp], kLeastModelChangeDolp);
  if (result.model_change_dolp > allowed) result.status |= kModelInaccurate;
}

PointResult Radiometry::assemble(const View& view, std::span<const Moments> moments,
                                 std::span<const Scattered> scattered) const {
  const bool bistatic = scene_.geometry.mode == Mode::kBistatic;
  const double cos_theta = view.direction.cos_theta;
  PointResult result;
  PerSample<Reflectance> reflectances;
  for (std::size_t j = 0; j < moments.size(); ++j) {
    reflectances.push_back(reflectance(scene_.surface, moments[j], cos_theta, view.diffuse[j].rho));
    if (is_unphysical(reflectances.back())) result.status |= kReflectanceOutsideZeroToOne;
  }
  const EmissionModel model = emission_model(scene_);
  const bool has_bracket = scene_.emission && scene_.emission->has_bracket;
  PerSample<Emissivity> kirchhoff, direct;
  for (std::size_t j = 0; model == EmissionModel::kMoments && j < moments.size(); ++j)
    kirchhoff.push_back(kirchhoff_emissivity(reflectances[j]));
  for (std::size_t j = 0; (model == EmissionModel::kDirect || has_bracket) && j < moments.size(); ++j)
    direct.push_back(direct_emissivity(scene_.surface, moments[j], cos_theta, view.diffuse[j].rho));
  const PerSample<Emissivity>* emissivities = &kirchhoff;
  if (model == EmissionModel::kDirect) emissivities = &direct;
  if (model == EmissionModel::kFresnel) emissivities = &view.fresnel;
  Stokes sum = stokes_sum(kept_rule_, reflectances, *emissivities, model, cos_theta, !bistatic);
  Stokes sky;
  add_sky(sky, scene_.surface, kept_rule_, sky_, view.diffuse, moments, cos_theta);
  if (kept_rule_.diffuse) sky.i += kept_rule_.diffuse->surroundings + view.cos_source * kept_rule_.diffuse->irradiance;
  sum.i += sky.i;
  sum.q += sky.q;
  sum.i_error += sky.i_error;
  sum.q_error += sky.q_error;
  sum.u += sky.u;
  sum.u_error += sky.u_error;
  if (bistatic) add_beam(sum, beam_specular_, kept_rule_, scattered, view.diffuse_beam, cos_theta);
  add_path(sum, scene_.path, kept_rule_.path_exitance);
  const double unit = bistatic ? 1.0 / pi : 1.0;  // `sum` is an exitance, and bistatic results are radiances
  const MeanReflectance mean = mean_reflectance(rule_, reflectances, view.mean_weights);
  result[kStokesI] = unit * sum.i;
  result[kStokesQ] = unit * sum.q + 0.0;  // adding 0 turns -0 into 0
  result[kStokesU] = unit * sum.u + 0.0;
  result[kStokesV] = unit * sum.v + 0.0;
  result[kRhoI] = mean.rho_i;
  result[kRhoQ] = mean.rho_q;
  result[kRhoU] = mean.rho_u + 0.0;
  result[kAlbedo] = moments.front().albedo / cos_theta;
  result[kRhoErrorEstimate] = relative_bound(mean.error, mean.rho_i);
  set_dolp(result, sum);
  if (scene_.emission) add_emissivity(result, *emissivities, view.mean_weights);
  if (has_bracket) {
    const Bracket between = bracket(scene_, kept_rule_, reflectances, direct, sky, cos_theta);
    result[kDolpLow] = between.low;
    result[kDolpHigh] = between.high;
    result[kErrorEstimate] = std::max(result[kErrorEstimate], between.error);
  }
  if (!scene_.surface.has_only_direct()) {
    result.model_change =
        change_by_model(scene_, kept_rule_, moments, reflectances, *emissivities, cos_theta) / std::abs(sum.i);
  }
  if (result.model_change > kLargestModelChange) result.status |= kModelInaccurate;
  if (sum.i <= 0.0) result.status |= kIntensityNotPositive;
  if (std::isnan(result[kDolp])) result.status |= kOutsideModelDomain;
  return result;
}

}  // namespace dolp
