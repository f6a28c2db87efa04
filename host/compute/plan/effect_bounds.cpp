#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/numbers.hpp"
#include "beams/beam_geometry.hpp"
#include "model/angles.hpp"
#include "model/direction.hpp"
#include "model/scattering.hpp"
#include "model/slopes.hpp"
#include "model/smooth_surface.hpp"
#include "plan/effects.hpp"

namespace dolp {
namespace {

constexpr double kRounding = 1e-8;  // relative rounding error of the bounds, and of sums over spectral samples
constexpr double kRoundingOfOne = 1e-13;
constexpr double kSmallestCosine = 1e-300;  // safe as a divisor
// Bounds of more beams would take as long as the beams. Such a run keeps the source.
constexpr std::size_t kMostBoundedBeams = std::size_t{1} << 16U;

constexpr std::array<bool KeptEffects::*, 8> kFlags = {  // in the order of Part
    &KeptEffects::further_bounces, &KeptEffects::moments,       &KeptEffects::source,  &KeptEffects::surroundings,
    &KeptEffects::emission,        &KeptEffects::path_radiance, &KeptEffects::diffuse, &KeptEffects::profile};

bool KeptEffects::*flag(Part part) { return kFlags[static_cast<std::size_t>(part)]; }

double or_infinite(double bound) { return std::isnan(bound) ? kInfinity : bound; }

/// Upper bound of Smith's Lambda: half the mean absolute slope in one plane, divided by cot(theta).
double most_lambda(Distribution distribution, const SlopeShape& shape, const CosSin& a) {
  if (shape.sigma == 0.0 || a.sin == 0.0) return 0.0;
  double mean = slope_width(shape) / kRootPi;
  if (distribution == Distribution::kCauchy) mean = shape.q > 1.5 ? mean / gamma_ratio(shape.q - 1.5) : kInfinity;
  return a.cos > 0.0 ? 0.5 * mean * a.sin / a.cos : kInfinity;
}

/// Upper bound of the albedo. With v-cavity and smith masking it is 1. With other maskings it follows from G <= 1.
double most_albedo(const Surface& surface, const CosSin& a, const SlopeShape& roughest) {
  return keeps_projected_area(surface.masking) ? 1.0 : 1.0 + most_lambda(surface.distribution, roughest, a);
}

struct Range {
  double least = 0.0;
  double most = kInfinity;
};

Range reflectance(const std::vector<FacetOptics>& indices, double cosine) {
  Range range{1.0, 0.0};
  for (const FacetOptics& index : indices) {
    const SmoothAbsorptance absorbed = smooth_absorptance(index, std::max(cosine, kSmallestCosine));
    const double mean = 1.0 - 0.5 * (absorbed.s + absorbed.p);
    range.least = std::min(range.least, std::max(0.0, mean - kRoundingOfOne));
    range.most = std::max(range.most, mean + kRoundingOfOne);
  }
  return range;
}

/// Range of the slope density P at `slope`, over all sigma and q of the entries. P rises with the slope width m until
/// m^2 = `peak` and then falls. Its two factors are monotonic in q, so the smallest and the largest q bound P.
Range slope_density(Distribution distribution, const EntriesExtent& extent, double slope) {
  const bool is_gaussian = distribution == Distribution::kGaussian;
  const double m2_low = std::pow(slope_width(extent.smoothest), 2);
  const double m2_high = std::pow(slope_width(extent.roughest), 2);
  const double q_low = extent.roughest.q;
  const double q_high = extent.smoothest.q;
  if (m2_low == 0.0) return {};  // a mirror
  const double t2 = slope * slope;
  const auto density = [&](double m2, double q) {
    return (is_gaussian ? std::exp(-t2 / m2) : std::exp(-q * std::log1p(t2 / m2))) / (std::numbers::pi * m2);
  };
  // At each azimuth an elliptic density equals the density of a width between its two widths, times at most their
  // quotient.
  const double ratio = extent.width_ratio;
  const double peak = is_gaussian ? t2 : (q_low - 1.0) * t2;
  return {(is_gaussian ? 1.0 : q_low - 1.0) / ratio * std::min(density(m2_low, q_high), density(m2_high, q_high)),
          (is_gaussian ? 1.0 : q_high - 1.0) * ratio * density(std::clamp(peak, m2_low, m2_high), q_low)};
}

/// Range of the element f_00 of the pBRDF times cos(theta_i) cos(theta_r), for k_s = 1, in 1/sr. It follows from ranges
/// of the slope density, of the reflectance (R_s + R_p) / 2 and of the masking G.
Range beam_range(const Surface& surface, const BeamAngles& angles, const EntriesExtent& extent,
                 const std::vector<FacetOptics>& indices) {
  if (!has_facet(angles)) return {};
  const BeamGeometry g = beam_geometry({angles.theta_i_deg, angles.theta_r_deg}, angles.delta_phi_deg);
  const double sec2 = 1.0 + g.slope * g.slope;
  Range masking{1.0, 1.0};
  if (surface.masking == Masking::kIntegral) masking.least = 0.5;
  if (surface.masking == Masking::kVCavity) masking.least = masking.most = v_cavity_attenuation(g);
  if (surface.masking == Masking::kSmith)
    masking.least = 1.0 / (1.0 + most_lambda(surface.distribution, extent.roughest, g.i) +
                           most_lambda(surface.distribution, extent.roughest, g.r));
  const Range density = slope_density(surface.distribution, extent, g.slope);
  const Range reflected = reflectance(indices, g.cos_beta);
  const double jacobian = 0.25 * sec2 * sec2;
  return {jacobian * density.least * masking.least * reflected.least,
          jacobian * density.most * masking.most * reflected.most};
}

EntriesExtent extent_of_grid(const SceneModel& scene, const SceneEntries& entries) {
  EntriesExtent extent;
  for (std::size_t i = 0; i < entries.entries_per_direction(); ++i) extent.add(entries[i].shape);
  for (std::size_t i = 0; i < entries.directions(); ++i)
    extent.beams.push_back(beam_angles(scene, entries[i * entries.entries_per_direction()]));
  for (const OpticalConstants& index : entries.own_indices()) extent.optics.emplace_back(index);
  return extent;
}

/// All optics that facets can have: the scene's at each wavelength, and each index of the entries with these films.
std::vector<FacetOptics> bounding_indices(const SpectralRule& rule, const EntriesExtent& extent) {
  std::vector<FacetOptics> indices = rule.indices();
  const std::vector<FacetOptics> samples = indices;
  for (const FacetOptics& entry_optics : extent.optics) {
    for (FacetOptics sample : samples) {
      sample.index = entry_optics.index;
      indices.push_back(std::move(sample));
      if (entry_optics.is_bare() && samples.front().is_bare()) break;
    }
  }
  return indices;
}

}  // namespace

void EntriesExtent::add(const SlopeShape& shape) {
  roughest = {std::max(roughest.sigma, widest_sigma(shape)), std::min(roughest.q, shape.q)};
  smoothest = {std::min(smoothest.sigma, narrowest_sigma(shape)), std::max(smoothest.q, shape.q)};
  if (is_elliptic(shape)) width_ratio = std::max(width_ratio, widest_sigma(shape) / narrowest_sigma(shape));
}

std::vector<EntriesExtent> entry_extents(const SceneModel& scene, const SceneEntries& entries) {
  if (entries.is_grid()) return {extent_of_grid(scene, entries)};
  std::vector<EntriesExtent> extents(entries.variants().size());
  for (const SceneEntry& entry : entries.all()) {
    EntriesExtent& extent = extents[entry.variant];
    extent.beams.push_back(beam_angles(scene, entry));
    extent.add(entry.shape);
    if (entry.index) extent.optics.push_back(*entry.index);
  }
  return extents;
}

bool is_kept(const KeptEffects& kept, Part part) { return kept.*flag(part); }

KeptEffects without(KeptEffects kept, Part part) {
  kept.*flag(part) = false;
  return kept;
}

struct EffectBounds::Sums {
  double least_i = 0.0;
  double most_qu = 0.0;  ///< upper bound of sqrt(Q^2 + U^2)
  double most_polarisation = kInfinity;
};

EffectBounds::EffectBounds(const SceneModel& scene, const SpectralRule& rule, const EntriesExtent& extent)
    : scene_(scene), is_bistatic_(scene.geometry.mode == Mode::kBistatic) {
  for (const SpectralSample& sample : rule.samples) {
    total_.emitted += sample.emitted;
    total_.surroundings += std::abs(sample.surroundings);
    total_.excess += std::abs(sample.excess);
    total_.irradiance += std::abs(sample.irradiance);
    double apart = 0.0;
    for (const double radiation : sample.sky) apart = std::max(apart, std::abs(radiation));
    sky_apart_ += apart;
    has_negative_ |= sample.emitted < 0.0 || sample.surroundings < 0.0 || sample.irradiance < 0.0;
  }
  path_ = rule.path_exitance;
  if (extent.beams.empty()) return;
  const Surface& surface = scene_.surface;
  const auto zenith = is_bistatic_ ? &BeamAngles::theta_r_deg : &BeamAngles::theta_i_deg;
  const double moment_zenith_deg = (*std::ranges::max_element(extent.beams, {}, zenith)).*zenith;
  const CosSin a = cos_sin_deg(zenith_before_limit_deg(surface.masking, moment_zenith_deg));
  most_specular_ = surface.specular * most_albedo(surface, a, extent.roughest);
  const double c = surface.diffuse_exponent;
  const bool diverges = c < 0.0 && moment_zenith_deg == 90.0;
  if (surface.diffuse > 0.0) {
    most_diffuse_ =
        diverges ? kInfinity : 2.0 * surface.diffuse * std::pow(std::max(a.cos, kSmallestCosine), c) / (c + 2.0);
  }
  if (is_bistatic_ && total_.irradiance > 0.0) add_beams(extent, bounding_indices(rule, extent));
}

void EffectBounds::add_beams(const EntriesExtent& extent, const std::vector<FacetOptics>& indices) {
  const Surface& surface = scene_.surface;
  if (extent.beams.size() > kMostBoundedBeams) {
    most_beam_ = most_beam_qu_ = kInfinity;
    return;
  }
  const double c = surface.diffuse_exponent;
  least_beam_ = kInfinity;
  for (BeamAngles beam : extent.beams) {
    beam.theta_r_deg = zenith_before_limit_deg(surface.masking, beam.theta_r_deg);
    const double cosine = std::max(cos_sin_deg(beam.theta_r_deg).cos, kSmallestCosine);
    const Range f = beam_range(surface, beam, extent, indices);
    const double to_exitance = std::numbers::pi * surface.specular / cosine;
    const double diffuse = surface.diffuse * std::pow(cos_sin_deg(beam.theta_i_deg).cos, c + 1.0) * std::pow(cosine, c);
    if (surface.specular > 0.0) most_beam_qu_ = std::max(most_beam_qu_, to_exitance * f.most);
    most_beam_ = std::max(most_beam_, most_beam_qu_ + diffuse);
    least_beam_ = std::min(least_beam_, to_exitance * f.least + (surface.diffuse_table ? 0.0 : diffuse));
  }
  if (surface.scattering == Scattering::kMultiple)
    most_beam_ = most_beam_qu_ = kInfinity;  // further bounces have no closed form
}

bool EffectBounds::emits(const KeptEffects& kept, EmissionModel model) const {
  return kept.emission && scene_.emission && scene_.emission->model == model;
}

/// Upper bound of the exitance that multiplies the reflectance rho.
double EffectBounds::weight(const KeptEffects& kept) const {
  const double emitted = emits(kept, EmissionModel::kMoments) ? total_.emitted : 0.0;
  const double source = is_bistatic_ || !kept.source ? 0.0 : total_.irradiance;
  if (!kept.surroundings || !scene_.surroundings) return emitted + source;
  return (emitted != 0.0 ? total_.excess : total_.surroundings) + (kept.profile ? sky_apart_ : 0.0) + source;
}

double EffectBounds::most_rho(const KeptEffects& kept) const { return kept.moments ? most_specular_ : 0.0; }

EffectBounds::Sums EffectBounds::sums(const KeptEffects& kept) const {
  const double reflected = weight(kept);
  const double all_rho = most_rho(kept) + most_diffuse_;
  const double beam = is_bistatic_ && kept.source ? total_.irradiance : 0.0;
  const bool has_rho = emits(kept, EmissionModel::kMoments);
  Sums sum;
  sum.most_qu = reflected * 0.5 * most_rho(kept);
  if (beam > 0.0) sum.most_qu += beam * most_beam_qu_;
  if (beam > 0.0 && !has_negative_) sum.least_i += beam * least_beam_;
  if (has_rho) sum.least_i += total_.emitted - (reflected > 0.0 ? reflected * all_rho : 0.0);
  if (!has_rho && kept.emission) sum.most_qu += 0.5 * total_.emitted;
  if (scene_.path) {
    sum.least_i = scene_.path->transmittance * sum.least_i + (kept.path_radiance ? path_ : 0.0);
    sum.most_qu *= scene_.path->transmittance;
  }
  if (sum.least_i > 0.0) sum.most_polarisation = or_infinite(sum.most_qu / sum.least_i);
  if (!has_negative_ && (!has_rho || all_rho <= 1.0)) sum.most_polarisation = std::min(1.0, sum.most_polarisation);
  return sum;
}

/// Upper bounds of |I| and sqrt(Q^2 + U^2) of the light that `part` adds.
std::array<double, 2> EffectBounds::added_by(Part part, const KeptEffects& kept) const {
  const double rho = most_rho(kept);
  const double all_rho = rho + most_diffuse_;
  const double transmittance = scene_.path ? scene_.path->transmittance : 1.0;
  if (part == Part::kSource && is_bistatic_)
    return {total_.irradiance * most_beam_ * transmittance, total_.irradiance * most_beam_qu_ * transmittance};
  if (part == Part::kSurroundings) {
    const double exitance = total_.surroundings + (kept.profile ? sky_apart_ : 0.0);
    return {exitance * all_rho * transmittance, exitance * 0.5 * rho * transmittance};
  }
  if (part == Part::kEmission) {
    return {total_.emitted * std::max(1.0, all_rho - 1.0) * transmittance,
            total_.emitted * 0.5 * std::max(1.0, rho) * transmittance};
  }
  if (part == Part::kPathRadiance) return {path_, 0.0};
  return {kInfinity, kInfinity};
}

bool EffectBounds::adds_nothing(Part part, const KeptEffects& kept) const {
  const Surface& surface = scene_.surface;
  const bool needs_direct = emits(kept, EmissionModel::kDirect) && surface.specular > 0.0;
  // Further bounces add light to the moments, and also to the beam of a bistatic scene.
  const bool has_beam = is_bistatic_ && kept.source && total_.irradiance > 0.0 && surface.specular > 0.0;
  switch (part) {
    case Part::kFurtherBounces:
      return surface.scattering == Scattering::kSingle || (!has_beam && adds_nothing(Part::kMoments, kept));
    case Part::kMoments:
      return surface.specular == 0.0 || (!needs_direct && weight(kept) == 0.0);
    case Part::kSource:
      return total_.irradiance == 0.0;
    case Part::kSurroundings:
      return total_.surroundings == 0.0;
    case Part::kProfile:
      return !kept.surroundings || sky_apart_ == 0.0;
    case Part::kEmission:
      return total_.emitted == 0.0;
    case Part::kPathRadiance:
      return path_ == 0.0;
    case Part::kDiffuse:
      return surface.diffuse == 0.0;
  }
  return false;
}

double EffectBounds::bound(Part part, const KeptEffects& kept) const {
  if (!is_kept(kept, part) || adds_nothing(part, kept)) return 0.0;
  // The bounds hold only if the diffuse part is unpolarised.
  if (scene_.surface.diffuse > 0.0 && scene_.surface.diffuse_polarisation != DiffusePolarisation::kNone)
    return kInfinity;
  const auto [added_i, added_qu] = added_by(part, kept);
  const double least_i = sums(without(kept, part)).least_i;
  if (!(least_i > 0.0)) return kInfinity;
  const double both = added_qu + (added_i > 0.0 ? sums(kept).most_polarisation * added_i : 0.0);
  return or_infinite(both / least_i) * (1.0 + kRounding);
}

}  // namespace dolp
