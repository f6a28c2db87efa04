// The effects of a scene, and the selection of those that a run drops because their change is negligible.
#pragma once

#include <dolp/effect.hpp>
#include <memory>
#include <string>
#include <vector>

#include "model/kept_effects.hpp"
#include "model/scene_entry.hpp"
#include "plan/constants.hpp"
#include "plan/effect_bounds.hpp"
#include "scene/scene.hpp"
#include "spectrum/sky_factors.hpp"

namespace dolp {

/// A part that is dropped, and the bound of the change at any entry.
struct DroppedPart {
  Part part;
  double bound;  ///< of (Q/I, U/I), hence of DOLP
};

/// The effects that a run computes at its entries.
struct EffectPlan {
  bool keep_all = false;
  KeptEffects kept;
  std::vector<DroppedPart> dropped;     ///< in the order of dropping; parts that the scene lacks are not among them
  double bound = 0.0;                   ///< of all dropped parts together
  bool needs_direct = false;            ///< those of the direct emission too
  bool needs_beams = false;             ///< f of the source's and the view's direction
  std::shared_ptr<const SkyBasis> sky;  ///< of the moments with a sky; none without a profile, see with_sky
  bool gives_rho = true;  ///< rho_i, rho_q and rho_error_estimate are known; the albedo with the moments alone
};

/// The effects that the scene's output needs at these entries.
///
/// A part is dropped if the bound of EffectBounds leaves the sum of all dropped parts at kDroppedShare of the tolerance
/// or below. The moments are tried first, then the source, the profile, the surroundings, the emission and the path,
/// then the moments again. Further bounces go with the moments alone: a bound of what they change costs more than it
/// saves. Each bound is that of the scene without the parts dropped before, so that the sum bounds the whole change;
/// except for the moments, a part's bound in the whole scene counts too. A part that contributes exactly nothing is
/// dropped at no cost: the moments where emission and surroundings have one temperature, for instance. Model choices
/// (distribution, masking, k) and the diffuse part are never dropped. `keep_all` keeps everything that the scene has.
EffectPlan plan_effects(const SceneValues& scene, const SceneEntries& entries, bool keep_all);

/// The plan of a run that computes `kept`: its needs and its results.
EffectPlan plan_to_keep(const SceneValues& scene, const KeptEffects& kept);

/// The plan that drops nothing, as `plan_effects` returns it with `keep_all`.
EffectPlan keep_everything(const SceneValues& scene);

/// The plan with the basis of its sky, that of the wavelengths of these entries, where the moments need one and it has
/// none.
EffectPlan with_sky(EffectPlan plan, const SceneValues& scene, const SceneEntries& entries);

/// True if a run gives the emissivities: with an emission, unless they need moments that are dropped.
bool gives_emissivity(const SceneValues& scene, const EffectPlan& plan);

/// All effects, in the order of the scene file.
std::vector<Effect> effects_of(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan);

/// One line for reports and table attributes: the effects that are kept, those that are dropped, and the reasons.
std::string effects_text(const std::vector<Effect>& rows, const EffectPlan& plan);

}  // namespace dolp
