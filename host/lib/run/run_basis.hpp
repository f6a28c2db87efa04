// Chooses the responses from which a run combines the moments of its many indices.
#pragma once

#include <memory>

#include "model/response_basis.hpp"
#include "model/scene_entry.hpp"
#include "plan/effects.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// The basis of a run, at the tolerance of the scene: tighter levels are for the quadrature. It follows from the whole
/// grid, of which the entries may be a part.
///
/// Null where a basis saves nothing: for a grid with few entries of each index, points that mostly differ in direction
/// or slope distribution, few indices, many bounces, and for a scene without interpolation.
std::shared_ptr<const ResponseBasis> run_basis(const SceneValues& scene, const SceneEntries& entries,
                                               const EffectPlan& plan);

}  // namespace dolp
