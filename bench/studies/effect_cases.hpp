// The scenes of the study of effects: pairs that differ in one effect.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace dolp::bench {

/// One scene of a group.
struct EffectSetting {
  std::string name;  ///< "smith", "off", ...
  SceneValues scene;
};

/// Scenes that differ only in one effect. The first is the base of the ratios.
struct EffectGroup {
  std::string effect;
  std::string mode;  ///< "hemispherical" or "bistatic"
  std::vector<EffectSetting> settings;
};

/// All groups, in the order of scene files. Every scene has the same grid of about `entries` entries: theta from 0 to
/// 85 degrees, sigma from 0.05 to 1, and one q, so that all models share moments equally. The sun at 10.6 um has a
/// tolerance of 1e-2.
std::vector<EffectGroup> effect_groups(std::size_t entries);

}  // namespace dolp::bench
