// What a scene asks for, effect by effect, and which of it a run leaves out because it cannot be seen.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/kept_effects.hpp"
#include "model/scene_entry.hpp"
#include "plan/effect_bounds.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// What all dropped effects together may change: this share of the scene's tolerance.
inline constexpr double kDroppedShare = 0.1;

/// A part that is left out, and what that changes at most at any entry.
struct DroppedPart {
  Part part;
  DropBound bound;
};

/// Which effects a run computes at its entries.
struct EffectPlan {
  bool keep_all = false;
  KeptEffects kept;
  std::vector<DroppedPart> dropped;  ///< in the order of dropping; parts that the scene lacks are not among them
  DropBound bound;                   ///< of all dropped parts together
  bool needs_moments = true;         ///< the specular moments, at theta or in bistatic mode at the view
  bool needs_direct = false;         ///< those of the direct emission too
  bool needs_beams = false;          ///< f of the source's and the view's direction
  bool gives_rho = true;  ///< rho_i, rho_q and rho_error_estimate are known; the albedo with the moments alone
};

/// The effects that the scene's output needs at these entries.
///
/// A part goes, in the order of Part but for the moments first and once more before further bounces, if the bound of
/// EffectBounds leaves the sum of all that is dropped at kDroppedShare of the tolerance or below; each bound is that of
/// the scene without what was dropped before, so that the sum bounds the whole change; but for the moments a part's
/// bound in the whole scene counts too. A part that adds exactly nothing goes at no cost: the moments where emission
/// and surroundings have one temperature, for instance. Model choices (distribution, masking, k) and the diffuse part
/// never go. `keep_all` keeps everything that the scene has.
EffectPlan plan_effects(const SceneValues& scene, const SceneEntries& entries, bool keep_all);

/// What a run that computes `kept` needs and gives.
EffectPlan plan_to_keep(const SceneValues& scene, const KeptEffects& kept);

/// Nothing left out: what `plan_effects` says with `keep_all`.
EffectPlan keep_everything(const SceneValues& scene);

/// Whether a run knows the emissivities: with an emission, unless they need moments that are left out.
bool gives_emissivity(const SceneValues& scene, const EffectPlan& plan);

/// What a run has to compute.
struct Needs {
  bool moments = false;
  bool beams = false;
};

/// What the run would have to compute if one more part were not there.
Needs needs_without(const SceneValues& scene, const EffectPlan& plan, Part part);

enum class EffectState {
  kAbsent,     ///< the scene does not ask for it
  kKept,       ///< computed
  kDropped,    ///< left out: a bound says that it cannot be seen
  kNotNeeded,  ///< a choice of the model that nothing kept depends on
};

/// One effect for a reader.
struct EffectRow {
  const char* name = "";
  EffectState state = EffectState::kKept;
  std::string reason = {};
  std::string needs = {};                ///< what computing it takes; empty when it is not kept
  std::optional<Part> part = {};         ///< what the sums lose with it; none for model choices
  std::optional<double> bound = {};      ///< of a dropped one: of the change of (Q/I, U/I) without it
  std::optional<double> influence = {};  ///< of a kept one: estimate of that change
};

/// All effects that there are, in the order of the scene file.
std::vector<EffectRow> effect_rows(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan);

const char* state_name(EffectState state);

/// One line for reports and table attributes: what is kept, what is dropped and why.
std::string effects_text(const std::vector<EffectRow>& rows, const EffectPlan& plan);

}  // namespace dolp
