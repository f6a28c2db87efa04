#include "plan/influence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/numbers.hpp"
#include "model/angles.hpp"
#include "model/direction.hpp"
#include "model/smooth_surface.hpp"

namespace dolp {
namespace {

using std::numbers::pi;

// Rounding of the sums here, and of the band sums that they stand for.
constexpr double kRounding = 1e-8;
// A cosine that may be divided by.
constexpr double kSmallestCosine = 1e-300;
constexpr double kMostDirectQ = 0.5;  // of |eps_Q| of the direct emission, because |M01| is at most R_s / 2

double finite_or_infinite(double bound) {
  if (std::isnan(bound)) return kInfinity;
  return bound;
}

bool KeptEffects::*flag(Part part) {
  switch (part) {
    case Part::kFurtherBounces:
      return &KeptEffects::further_bounces;
    case Part::kMoments:
      return &KeptEffects::moments;
    case Part::kSource:
      return &KeptEffects::source;
    case Part::kSurroundings:
      return &KeptEffects::surroundings;
    case Part::kEmission:
      return &KeptEffects::emission;
    case Part::kPathRadiance:
      return &KeptEffects::path_radiance;
    case Part::kDiffuse:
      return &KeptEffects::diffuse;
  }
  return nullptr;
}

bool changes_rho(Part part) {
  return part == Part::kMoments || part == Part::kFurtherBounces || part == Part::kDiffuse;
}

}  // namespace

bool is_kept(const KeptEffects& kept, Part part) { return kept.*flag(part); }

KeptEffects without(KeptEffects kept, Part part) {
  kept.*flag(part) = false;
  return kept;
}

const ReflectanceBounds& ReflectanceMemory::bounds(const Surface& surface, double theta_deg, const SceneEntry& entry,
                                                   std::span<const OpticalConstants> indices, Detail detail) {
  Slot& slot = slots_[static_cast<std::size_t>(detail)];
  const bool is_same =
      slot.is_filled && slot.theta_deg == theta_deg && slot.shape == entry.shape && slot.index == entry.index;
  if (!is_same) {
    slot = {true, theta_deg, entry.shape, entry.index,
            detail == Detail::kCoarse ? coarse_reflectance_bounds(surface, theta_deg, entry.shape)
                                      : reflectance_bounds(surface, theta_deg, entry.shape, indices, detail)};
  }
  return slot.bounds;
}

const CosSin& ReflectanceMemory::direction(double theta_deg) {
  if (theta_deg != theta_deg_) {
    theta_deg_ = theta_deg;
    direction_ = cos_sin_deg(theta_deg);
  }
  return direction_;
}

/// Bounds of Stokes sums.
struct InfluenceBounds::Sums {
  double least_i = 0.0;
  double most_i = 0.0;   ///< of |I|; only of what a part adds
  double most_qu = 0.0;  ///< of the length of (Q, U)
  bool is_physical = false;
};

/// What the sums at an entry are made of.
struct InfluenceBounds::AtEntry {
  ReflectanceBounds specular;  ///< times k_s
  double further = 0.0;        ///< of rho_I and rho_Q by bounces after the first, at most; in `specular` too
  double diffuse = 0.0;        ///< of rho
  BeamBounds beam;             ///< exitance for E0 = 1, times k_s
  double diffuse_beam = 0.0;
  double smooth_emitted = 0.0;  ///< of the fresnel emission
  double smooth_split = 0.0;    ///< its |Q| at most
  double source_cosine = 0.0;   ///< of E0 cos(theta) in hemispherical mode, else 0
};

InfluenceBounds::InfluenceBounds(const Scene& scene, const SpectralRule& rule)
    : scene_(scene),
      indices_(rule.indices()),
      path_(rule.path_exitance),
      bistatic_(scene.geometry.mode == Mode::kBistatic) {
  for (const SpectralSample& sample : rule.samples) {
    total_.emitted += sample.emitted;
    total_.surroundings += std::abs(sample.surroundings);
    total_.excess += std::abs(sample.excess);
    total_.irradiance += std::abs(sample.irradiance);
    emitted_.push_back(sample.emitted);
    has_negative_ |= sample.emitted < 0.0 || sample.surroundings < 0.0 || sample.irradiance < 0.0;
  }
}

InfluenceBounds::AtEntry InfluenceBounds::at_entry(const KeptEffects& kept, const SceneEntry& entry, Detail detail,
                                                   ReflectanceMemory& memory) const {
  const Surface& surface = scene_.surface;
  const double theta_deg =
      zenith_before_limit_deg(surface.masking, bistatic_ ? scene_.geometry.view_zenith_deg : entry.theta_deg);
  const CosSin direction = memory.direction(theta_deg);
  const double cosine = std::max(direction.cos, kSmallestCosine);
  const std::vector<OpticalConstants> own = entry.index ? std::vector{*entry.index} : indices_;
  AtEntry at;
  if (kept.moments && surface.specular > 0.0) {
    at.specular = memory.bounds(surface, theta_deg, entry, own, detail);
    for (double* value : {&at.specular.most_i, &at.specular.most_q, &at.specular.least_i}) *value *= surface.specular;
    if (kept.further_bounces && surface.scattering == Scattering::kMultiple) {
      const double slope = std::tan((30.0 - theta_deg / 3.0) * pi / 180.0);
      at.further = surface.specular * steeper_share(surface.distribution, entry.shape, slope);
      at.specular.most_i = std::min(at.specular.most_i + at.further, surface.specular);
      at.specular.most_q += at.further;
    }
  }
  const double c = surface.diffuse_exponent;
  const bool has_diffuse = kept.diffuse && surface.diffuse > 0.0;
  const bool diverges = c < 0.0 && (bistatic_ ? scene_.geometry.view_zenith_deg : entry.theta_deg) == 90.0;
  if (has_diffuse) at.diffuse = diverges ? kInfinity : 2.0 * surface.diffuse * std::pow(cosine, c) / (c + 2.0);
  if (bistatic_ && kept.source && total_.irradiance > 0.0) {
    const Geometry& geometry = scene_.geometry;
    at.beam = beam_bounds(surface, entry.theta_deg, theta_deg, geometry.relative_azimuth_deg, entry.shape, own);
    for (double* value : {&at.beam.most_i, &at.beam.least_i, &at.beam.most_qu}) {
      *value *= pi * surface.specular / cosine;
    }
    if (kept.further_bounces && surface.scattering == Scattering::kMultiple) {
      at.beam.most_i = at.beam.most_qu = kInfinity;  // they are not known before they are computed
    }
    const double cosine_i = cos_sin_deg(entry.theta_deg).cos;
    if (has_diffuse) at.diffuse_beam = surface.diffuse * std::pow(cosine_i, c + 1.0) * std::pow(cosine, c);
  }
  if (!bistatic_) at.source_cosine = direction.cos;
  for (std::size_t j = 0; j < emitted_.size(); ++j) {
    const SmoothAbsorptance absorbed = smooth_absorptance(own[entry.index ? 0 : j], cosine);
    at.smooth_emitted += 0.5 * emitted_[j] * (absorbed.s + absorbed.p);
    at.smooth_split += 0.5 * std::abs(emitted_[j] * (absorbed.s - absorbed.p));
  }
  return at;
}

/// Whether the emission is 1 - rho.
bool InfluenceBounds::is_kirchhoff() const {
  return scene_.emission && scene_.emission->model == EmissionModel::kMoments;
}

/// The exitance that the specular and diffuse parts of rho are multiplied by, at most: of emission and surroundings.
double InfluenceBounds::weight(const KeptEffects& kept) const {
  const double emitted = kept.emission && is_kirchhoff() ? total_.emitted : 0.0;
  const double surroundings = kept.surroundings ? total_.surroundings : 0.0;
  if (emitted != 0.0 && kept.surroundings && scene_.surroundings) return total_.excess;
  return std::max(emitted, surroundings);
}

InfluenceBounds::Sums InfluenceBounds::sums(const KeptEffects& kept, const AtEntry& at) const {
  const bool fresnel = scene_.emission && scene_.emission->model == EmissionModel::kFresnel;
  const bool direct = scene_.emission && scene_.emission->model == EmissionModel::kDirect;
  const double surroundings = kept.surroundings ? total_.surroundings : 0.0;
  const double source = kept.source ? total_.irradiance : 0.0;
  const double certain = has_negative_ ? 0.0 : 1.0;  // weights of both signs leave nothing certain
  const double least = certain * (at.specular.least_i + at.diffuse);
  const double most = at.specular.most_i + at.diffuse;
  const double incident = source * at.source_cosine;
  Sums sum;
  sum.is_physical = !has_negative_;
  sum.least_i = incident * least + certain * source * (at.beam.least_i + at.diffuse_beam);
  sum.most_qu = incident * at.specular.most_q + source * at.beam.most_qu;
  if (kept.emission && fresnel) {
    sum.least_i += at.smooth_emitted + surroundings * least;
    sum.most_qu += at.smooth_split + surroundings * at.specular.most_q;
  } else if (kept.emission && direct) {
    sum.least_i += surroundings * least;
    sum.most_qu += kMostDirectQ * total_.emitted + surroundings * at.specular.most_q;
  } else if (kept.emission && total_.emitted > 0.0) {
    const double gap = weight(kept);
    const bool is_colder = surroundings < total_.emitted;
    sum.least_i += total_.emitted + (gap == 0.0 ? 0.0 : is_colder ? -gap * most : gap * least);
    sum.most_qu += gap == 0.0 ? 0.0 : gap * at.specular.most_q;
    sum.is_physical &= gap == 0.0 || most <= 1.0;
  } else {
    sum.least_i += surroundings * least;
    sum.most_qu += surroundings * at.specular.most_q;
  }
  if (scene_.path) {
    const double transmittance = scene_.path->transmittance;
    sum.least_i = transmittance * sum.least_i + (kept.path_radiance ? path_ : 0.0);
    sum.most_qu *= transmittance;
  }
  return sum;
}

InfluenceBounds::Sums InfluenceBounds::added_by(Part part, const KeptEffects& kept, const AtEntry& at) const {
  const bool fresnel = scene_.emission && scene_.emission->model == EmissionModel::kFresnel;
  const bool direct = scene_.emission && scene_.emission->model == EmissionModel::kDirect;
  const double most = at.specular.most_i + at.diffuse;
  const double source = kept.source ? total_.irradiance : 0.0;
  const double incident = source * at.source_cosine;
  Sums sum;
  switch (part) {
    case Part::kFurtherBounces:
      sum.most_i = sum.most_qu = (weight(kept) + incident) * at.further;
      if (bistatic_ && source > 0.0) sum.most_i = sum.most_qu = kInfinity;
      break;
    case Part::kMoments:
      sum.most_i = direct && kept.emission ? kInfinity : (weight(kept) + incident) * at.specular.most_i;
      sum.most_qu = (weight(kept) + incident) * at.specular.most_q;
      break;
    case Part::kSource:
      sum.most_i = incident * most + source * (at.beam.most_i + at.diffuse_beam);
      sum.most_qu = incident * at.specular.most_q + source * at.beam.most_qu;
      break;
    case Part::kSurroundings:
      sum.most_i = total_.surroundings * most;
      sum.most_qu = total_.surroundings * at.specular.most_q;
      break;
    case Part::kEmission:
      sum.most_i = fresnel ? at.smooth_emitted : direct ? total_.emitted : total_.emitted * std::max(1.0, most - 1.0);
      sum.most_qu = fresnel  ? at.smooth_split
                    : direct ? kMostDirectQ * total_.emitted
                             : total_.emitted * at.specular.most_q;
      break;
    case Part::kPathRadiance:
      sum.most_i = path_;
      break;
    case Part::kDiffuse:
      sum.most_i = (weight(kept) + incident) * at.diffuse + source * at.diffuse_beam;
      break;
  }
  if (scene_.path && part != Part::kPathRadiance) {
    sum.most_i *= scene_.path->transmittance;
    sum.most_qu *= scene_.path->transmittance;
  }
  return sum;
}

bool InfluenceBounds::adds_nothing(Part part, const KeptEffects& kept) const {
  const Surface& surface = scene_.surface;
  const double into_hemisphere = bistatic_ || !kept.source ? 0.0 : total_.irradiance;
  const bool emits_directly = kept.emission && scene_.emission && scene_.emission->model == EmissionModel::kDirect;
  switch (part) {
    case Part::kFurtherBounces:
      return surface.scattering == Scattering::kSingle || (!emits_directly && adds_nothing(Part::kMoments, kept));
    case Part::kMoments:
      if (emits_directly && surface.specular > 0.0) return false;
      return surface.specular == 0.0 || (weight(kept) == 0.0 && into_hemisphere == 0.0);
    case Part::kSource:
      return total_.irradiance == 0.0;
    case Part::kSurroundings:
      return total_.surroundings == 0.0;
    case Part::kEmission:
      return total_.emitted == 0.0;
    case Part::kPathRadiance:
      return path_ == 0.0;
    case Part::kDiffuse:
      return surface.diffuse == 0.0;
  }
  return false;
}

DropBound InfluenceBounds::bound(Part part, const KeptEffects& kept, const SceneEntry& entry, Detail detail) const {
  ReflectanceMemory memory;
  return bound(part, kept, entry, detail, memory);
}

DropBound InfluenceBounds::bound(Part part, const KeptEffects& kept, const SceneEntry& entry, Detail detail,
                                 ReflectanceMemory& memory) const {
  if (!is_kept(kept, part) || adds_nothing(part, kept)) return {};
  const AtEntry at = at_entry(kept, entry, detail, memory);
  const KeptEffects rest = without(kept, part);
  const Sums whole = sums(kept, at);
  const Sums left = sums(rest, changes_rho(part) ? at_entry(rest, entry, detail, memory) : at);
  const Sums added = added_by(part, kept, at);
  const auto polarisation = [](const Sums& sum) {
    const double most = sum.least_i > 0.0 ? finite_or_infinite(sum.most_qu / sum.least_i) : kInfinity;
    return sum.is_physical ? std::min(1.0, most) : most;
  };
  const auto change = [&](double other_polarisation, double least_i) {
    const double both = added.most_i == 0.0 ? added.most_qu : added.most_qu + other_polarisation * added.most_i;
    return least_i > 0.0 ? finite_or_infinite(both / least_i) : kInfinity;
  };
  DropBound bound;
  bound.dolp = std::min({change(polarisation(left), whole.least_i), change(polarisation(whole), left.least_i),
                         polarisation(whole) + polarisation(left)}) *
               (1.0 + kRounding);
  const bool gives_rho = kept.moments || scene_.surface.specular == 0.0;
  if (part == Part::kDiffuse && gives_rho) {
    bound.rho = finite_or_infinite(at.diffuse / (at.specular.least_i + at.diffuse)) * (1.0 + kRounding);
  }
  if (part == Part::kFurtherBounces && gives_rho) {
    bound.rho = finite_or_infinite(at.further / (at.specular.least_i + at.diffuse)) * (1.0 + kRounding);
  }
  return bound;
}

}  // namespace dolp
