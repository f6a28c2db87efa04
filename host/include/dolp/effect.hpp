// The effects of a scene, and their treatment.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace dolp {

enum class EffectState : std::uint8_t {
  kAbsent,     ///< the scene does not ask for it
  kKept,       ///< computed
  kDropped,    ///< left out: a bound shows that its change is negligible
  kNotNeeded,  ///< a choice of the model that nothing kept depends on
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
  kProfile  ///< of the surroundings, over their mean
};

/// An effect that a scene can ask for, and its treatment at some points.
struct Effect {
  std::string name;
  EffectState state = EffectState::kKept;
  std::string reason = {};
  std::string needs = {};                ///< quantities that it requires; empty when it is not kept
  std::optional<Part> part = {};         ///< none for choices of the model
  std::optional<double> bound = {};      ///< of a dropped one: of the change of (Q/I, U/I) without it, worst point
  std::optional<double> influence = {};  ///< of a kept one: estimate of that change, the largest of a few points
};

}  // namespace dolp
