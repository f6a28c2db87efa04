#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace dolp {

enum class EffectState : std::uint8_t {
  kAbsent,     ///< the scene does not have the effect
  kKept,       ///< computed
  kDropped,    ///< the run leaves the effect out, because a bound shows that the result hardly changes
  kNotNeeded,  ///< no kept effect uses this choice of the model, for example the masking without a specular part
};

constexpr const char* to_name(EffectState state) {
  constexpr const char* kNames[] = {"absent", "kept", "dropped", "not_needed"};
  return kNames[static_cast<std::uint8_t>(state)];
}

/// The contributions to the radiation that a run can drop.
enum class Part : std::uint8_t {
  kFurtherBounces,
  kMoments,
  kSource,
  kSurroundings,
  kEmission,
  kPathRadiance,
  kDiffuse,
  kProfile  ///< radiance of the surroundings minus its mean over directions
};

/// An effect that a scene can have, and what a run over given entries does with it.
struct Effect {
  std::string name;
  EffectState state = EffectState::kKept;
  std::string reason = {};
  std::string needs = {};  ///< what the run must compute for the effect, in words; empty if the effect is not kept
  std::optional<Part> part = {};  ///< contribution that the effect adds; empty for choices of the model
  /// For a dropped effect: upper bound, over all entries, of the change of (Q/I, U/I) that dropping it causes.
  std::optional<double> bound = {};
  /// For a kept effect: the largest change of (Q/I, U/I) without it, at a few entries computed with tolerance 1e-3.
  std::optional<double> influence = {};
};

}  // namespace dolp
