// The effects of a scene, and their treatment.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace dolp {

enum class EffectState : std::uint8_t {
  kAbsent,     ///< the scene does not have it
  kKept,       ///< computed
  kDropped,    ///< left out, because a bound shows that its effect is negligible
  kNotNeeded,  ///< a choice of the model that affects nothing that is kept
};

/// "absent", "kept", "dropped", "not_needed".
constexpr const char* name_of(EffectState state) {
  constexpr const char* kNames[] = {"absent", "kept", "dropped", "not_needed"};
  return kNames[static_cast<std::uint8_t>(state)];
}

/// The parts of the sums of radiation that can be dropped.
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

/// An effect that a scene can have, and its treatment at some points.
struct Effect {
  std::string name;
  EffectState state = EffectState::kKept;
  std::string reason = {};
  std::string needs = {};         ///< quantities that it needs; empty if it is not kept
  std::optional<Part> part = {};  ///< empty for choices of the model
  /// for a dropped effect: bound of the change of (Q/I, U/I) without it, at the worst point
  std::optional<double> bound = {};
  /// for a kept effect: estimate of the change of (Q/I, U/I) without it, the largest of a few points
  std::optional<double> influence = {};
};

}  // namespace dolp
