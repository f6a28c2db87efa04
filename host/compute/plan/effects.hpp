#pragma once

#include <array>
#include <dolp/effect.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "model/scene_entry.hpp"
#include "plan/constants.hpp"
#include "scene/scene.hpp"
#include "spectrum/sky_factors.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {

bool is_kept(const KeptEffects& kept, Part part);
KeptEffects without(KeptEffects kept, Part part);

struct EntriesExtent {
  std::vector<double> theta_deg;
  SlopeShape roughest;   ///< the largest sigma and the smallest q
  SlopeShape smoothest;  ///< the smallest sigma and the largest q
  std::vector<FacetOptics> optics;
};

/// A grid has one extent, because each direction has all variants of the scene. Points have one extent per variant.
std::vector<EntriesExtent> extents_of(const SceneEntries& entries);

/// Bounds of the change that each part of a scene causes at any of the entries.
///
/// Derivation: a part adds (dI, dQ, dU) to the Stokes parameters. Let q = (Q, U) / I, and let a prime mark values
/// without the part. Then q - q' = ((dQ, dU) - q dI) / I'. The bounds of |dI| and |(dQ, dU)| follow from the bounds of
/// a bistatic beam and, with the albedo A, from 0 <= rho_I <= A and |rho_Q| <= A / 2. Let E, S and X be the exitances
/// of emission, surroundings and source; X is 0 in bistatic mode. With Kirchhoff's law I = E + (S - E + X) rho_I >= E -
/// (|S - E| + X) A, and Q = (S - E + X) rho_Q. So the moments have the weight |S - E| + X. It is 0 if emission and
/// surroundings have the same temperature and no source illuminates the hemisphere. A profile of the sky changes S by
/// at most its largest distance from its mean. Other emissions have no lower bound here. A path multiplies the Stokes
/// parameters by its transmittance, and adds to I. If A <= 1, every part has a degree of polarisation of at most 1, so
/// |q| <= 1. Bistatic radiances count times pi.
class EffectBounds {
 public:
  EffectBounds(const SceneModel& scene, const EntriesExtent& extent);

  /// Bound of the change of (Q/I, U/I), at any entry, if `part` is dropped from `kept`. The bound is exactly 0 if the
  /// part contributes nothing. Otherwise it is infinite if no bound is known, and always for moments, further bounces,
  /// profile, diffuse part and a source of the hemisphere, whose bounds would save no work in any known case.
  double bound(Part part, const KeptEffects& kept) const;

  /// True if the part contributes exactly nothing at every entry.
  bool adds_nothing(Part part, const KeptEffects& kept) const;

 private:
  struct Sums;
  void add_beams(const EntriesExtent& extent, const std::vector<FacetOptics>& indices);
  bool emits(const KeptEffects& kept, EmissionModel model) const;
  double weight(const KeptEffects& kept) const;
  double most_rho(const KeptEffects& kept) const;
  Sums sums(const KeptEffects& kept) const;
  std::array<double, 2> added_by(Part part, const KeptEffects& kept) const;

  SceneModel scene_;
  bool is_bistatic_;
  SpectralSample total_;       ///< sums of |factor| over the spectral samples; `emitted` keeps its sign
  double sky_apart_ = 0.0;     ///< the largest distance of a profile from its mean
  bool has_negative_ = false;  ///< a spectral weight is negative, as in the interpolation of a steep factor
  double path_;
  double most_specular_ = 0.0;  ///< upper bound of the specular rho_I
  double most_diffuse_ = 0.0;   ///< upper bound of the diffuse rho
  double most_beam_ = 0.0;      ///< upper bound of pi times the radiance into the view, for E0 = 1
  double most_beam_qu_ = 0.0;   ///< upper bound of the length of (Q, U) of this light
  double least_beam_ = 0.0;
};

struct EffectPlan {
  bool keep_all = false;
  KeptEffects kept;
  std::map<Part, double> dropped;       ///< for parts of the scene: bounds of the change of (Q/I, U/I)
  double bound = 0.0;                   ///< bound of the change by all dropped parts together
  bool needs_direct = false;            ///< the run needs the moments of the direct emission
  bool needs_beams = false;             ///< the run needs f from the source's direction into the view
  std::shared_ptr<const SkyBasis> sky;  ///< functions of the sky, set by with_sky; null without a profile
  bool gives_rho = true;  ///< rho_i, rho_q and rho_error_estimate are known; the albedo only with the moments
};

/// The effects that the scene's output needs. A part is dropped if the bounds of all dropped parts (EffectBounds) sum
/// to at most kDroppedShare of the tolerance. The source is tried first, then the surroundings, their profile, the
/// emission, the path, the moments, and the further bounces. Each bound is for the scene without the parts dropped
/// before, so the sum bounds the whole change. Except for moments and profile, each bound is at least the bound of the
/// part in the whole scene. A part that adds exactly nothing is always dropped. Model choices (distribution, masking,
/// k) and the diffuse part are never dropped. `keep_all` keeps everything.
EffectPlan plan_effects(const SceneValues& scene, const SceneEntries& entries, bool keep_all);

EffectPlan plan_to_keep(const SceneValues& scene, const KeptEffects& kept);

EffectPlan keep_everything(const SceneValues& scene);

/// Adds the basis of the sky at the wavelengths of these entries, if the moments need one and the plan has none.
EffectPlan with_sky(EffectPlan plan, const SceneValues& scene, const SceneEntries& entries);

/// True if the scene has an emission that does not need dropped moments.
bool gives_emissivity(const SceneValues& scene, const EffectPlan& plan);

std::vector<Effect> effects_of(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan);

/// One line for reports and table attributes: the effects that are kept, those that are dropped, and the reasons.
std::string effects_text(const std::vector<Effect>& rows, const EffectPlan& plan);

}  // namespace dolp
