#pragma once

#include <cstddef>
#include <vector>

#include "model/scene_entry.hpp"
#include "plan/effects.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// Number of entries at which influences are estimated; one spectral sample is enough there.
inline constexpr std::size_t kInfluenceEntries = 12;

/// Estimates what each kept part changes: the largest difference of (Q/I, U/I) between the scene with everything and
/// without the part, at up to kInfluenceEntries entries spread over these, on the CPU. None where no entry promises
/// its DOLP both ways.
///
/// Accuracy: 1e-3 each.
void add_influences(std::vector<EffectRow>& rows, const SceneValues& scene, const SceneEntries& entries);

}  // namespace dolp
