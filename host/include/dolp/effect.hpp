#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace dolp {

enum class EffectState : std::uint8_t {
  kAbsent,     ///< the scene does not have the effect
  kKept,       ///< computed
  kDropped,    ///< left out, because a bound shows that it changes the result negligibly
  kNotNeeded,  ///< a choice of the model that changes nothing in the kept effects
};

constexpr const char* name_of(EffectState state) {
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
  kProfile  ///< variation of the surroundings around their mean
};

/// An effect that a scene can have, and how a run at some points treats it.
struct Effect {
  std::string name;
  EffectState state = EffectState::kKept;
  std::string reason = {};
  std::string needs = {};         ///< quantities that the effect needs; empty if it is not kept
  std::optional<Part> part = {};  ///< contribution that the effect adds; empty for choices of the model
  /// For a dropped effect: bound of the change of (Q/I, U/I) by dropping it, at the worst point.
  std::optional<double> bound = {};
  /// For a kept effect: estimate of the change of (Q/I, U/I) if it were dropped, the largest at a few points.
  std::optional<double> influence = {};
};

}  // namespace dolp
