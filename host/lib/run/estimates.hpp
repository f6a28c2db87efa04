// Estimates of what a run leaves out or would change, from a few of its entries on the CPU.
#pragma once

#include <cstddef>
#include <optional>
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
void add_influences(std::vector<Effect>& rows, const SceneValues& scene, const SceneEntries& entries);

/// Number of entries at which the gap is estimated; one spectral sample is enough there.
inline constexpr std::size_t kGapEntries = 16;

/// How far single scattering may be off: the largest difference of DOLP between the emission 1 - rho, which counts all
/// that meets a second facet as emitted, and the direct one, which counts none of it. Of up to kGapEntries entries
/// spread over these, on the CPU; none where the scene follows all bounces, where its emission is not that of its
/// facets, with a masking without direct emission, in bistatic mode, and where nothing depends on the moments or no
/// entry promises its DOLP.
///
/// Accuracy: 1e-3 each.
std::optional<double> scattering_gap(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan);

}  // namespace dolp
