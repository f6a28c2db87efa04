// The effects of a scene. A run drops an effect if a closed-form bound proves that it hardly changes the polarisation.
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

/// Each part has a flag in KeptEffects. These functions read the flag, and clear it.
bool is_kept(const KeptEffects& kept, Part part);
KeptEffects without(KeptEffects kept, Part part);

/// Ranges of the parameters of some entries.
struct EntriesExtent {
  std::vector<double> theta_deg;
  SlopeShape roughest;              ///< the largest sigma and the smallest q
  SlopeShape smoothest;             ///< the smallest sigma and the largest q
  std::vector<FacetOptics> optics;  ///< optics of the facets of these entries
};

/// One extent for a grid, because each of its directions has all variants of the scene. For points, one extent per
/// variant.
std::vector<EntriesExtent> extents_of(const SceneEntries& entries);

/// Bounds of the change that each part of a scene causes at any of the entries.
///
/// Derivation: a part adds (dI, dQ, dU) to the Stokes sums. With q = (Q, U) / I, and a prime for the sums without the
/// part, q - q' = (dQ - q dI) / I'. |dI| and |dQ, dU| are factors of the scene times the bounds 0 <= rho_I <= A,
/// |rho_Q| <= A / 2 and bounds of the beam. With E, S, X the exitances of emission, surroundings and source (X only in
/// hemispherical mode), Kirchhoff's emission gives I = E + (S - E + X) rho >= E - (|S - E| + X) A and Q = (S - E + X)
/// rho_Q: the weight of the moments is |S - E| + X, which is 0 where emission and surroundings have one temperature and
/// no source illuminates the hemisphere. A profile of the sky adds at most its largest distance from its mean to S, in
/// any direction. The other emissions have no lower bound here. A path multiplies all by its transmittance and adds to
/// I. |q| <= 1 where A <= 1, which bounds rho_s and rho_p: in this case every part has a degree of polarisation of at
/// most 1. All Stokes parameters are in the units of the exitances, bistatic ones times pi; sums over a band are sums
/// over the spectral rule's samples.
class EffectBounds {
 public:
  EffectBounds(const SceneModel& scene, const EntriesExtent& extent);

  /// Bound of the change of (Q/I, U/I), at any entry, if `part` is dropped from `kept`. It is exactly 0 if the part
  /// contributes nothing. Otherwise it is infinite if no bound is known, and always for moments, further bounces,
  /// profile, diffuse part and a source of the hemisphere: no case is known in which their bounds would save work.
  double bound(Part part, const KeptEffects& kept) const;

  /// True if a part contributes exactly nothing at every entry.
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
  SpectralSample total_;       ///< sums of |factor| over the spectral samples; `emitted` sums with the sign
  double sky_apart_ = 0.0;     ///< the largest distance of a profile from its mean
  bool has_negative_ = false;  ///< some weights are negative, as in the interpolation of a steep factor
  double path_;
  double most_specular_ = 0.0;  ///< upper bound of the specular rho_I
  double most_diffuse_ = 0.0;   ///< upper bound of the diffuse rho
  double most_beam_ = 0.0;      ///< upper bound of pi times the radiance into the view, for E0 = 1
  double most_beam_qu_ = 0.0;   ///< upper bound of the length of (Q, U) of this light
  double least_beam_ = 0.0;
};

/// The effects that a run computes at its entries.
struct EffectPlan {
  bool keep_all = false;
  KeptEffects kept;
  std::map<Part, double> dropped;       ///< bounds of the change of (Q/I, U/I) by parts that the scene has
  double bound = 0.0;                   ///< bounds the change by all dropped parts together
  bool needs_direct = false;            ///< whether the run needs the moments of the direct emission
  bool needs_beams = false;             ///< whether the run needs f from the source's direction into the view
  std::shared_ptr<const SkyBasis> sky;  ///< functions of the sky, which with_sky sets; null without a profile
  bool gives_rho = true;  ///< rho_i, rho_q and rho_error_estimate are known; the albedo only with the moments
};

/// The effects that the scene's output needs at these entries.
///
/// A part is dropped if the bounds of all dropped parts (EffectBounds) sum to at most kDroppedShare of the tolerance.
/// The source is tried first, then the surroundings, their profile, the emission, the path, the moments, and the
/// further bounces. Each bound is for the scene without the parts dropped before, so the sum bounds the whole change. A
/// part's bound in the whole scene counts too, except for the moments. A part that contributes exactly nothing is
/// dropped at no cost, for instance the moments if emission and surroundings have one temperature. Model choices
/// (distribution, masking, k) and the diffuse part are never dropped. `keep_all` keeps everything that the scene has.
EffectPlan plan_effects(const SceneValues& scene, const SceneEntries& entries, bool keep_all);

/// The plan of a run that computes the effects of `kept`.
EffectPlan plan_to_keep(const SceneValues& scene, const KeptEffects& kept);

/// The plan that drops nothing: plan_effects with `keep_all`.
EffectPlan keep_everything(const SceneValues& scene);

/// Adds the basis of the sky at the wavelengths of these entries, if the moments need one and the plan has none.
EffectPlan with_sky(EffectPlan plan, const SceneValues& scene, const SceneEntries& entries);

/// True if a run gives the emissivities: the scene has an emission that does not need dropped moments.
bool gives_emissivity(const SceneValues& scene, const EffectPlan& plan);

/// All effects, in the order of the scene file.
std::vector<Effect> effects_of(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan);

/// One line for reports and table attributes: the effects that are kept, those that are dropped, and the reasons.
std::string effects_text(const std::vector<Effect>& rows, const EffectPlan& plan);

}  // namespace dolp
