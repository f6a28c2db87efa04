// The scenes of the study of effects. The scenes of a group differ in one effect.
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

/// Scenes that differ only in one effect. The study divides their times by the time of the first scene.
struct EffectGroup {
  std::string effect;
  std::string mode;  ///< "hemispherical" or "bistatic"
  std::vector<EffectSetting> settings;
};

/// All groups, in the order of the study's table. Every scene has a grid of about `entries` entries: theta from 0 to 85
/// degrees, sigma from 0.05 to 1, and q = 3. The scene `20 n x 20 k` has 400 times as many. The group `sun at 10.6 um`
/// has a tolerance of 1e-2, which suits a thermal camera. The other groups have the default tolerance.
std::vector<EffectGroup> effect_groups(std::size_t entries);

}  // namespace dolp::bench
