// Results of a band without the spectral rule.
#pragma once

#include <vector>

#include <dolp/options.hpp>
#include <dolp/results.hpp>
#include "model/evaluator.hpp"
#include "model/scene_entry.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// Results of a scene with a band at some points, for comparison.
///
/// Method: for each point an adaptive Gauss-Kronrod quadrature over the wavelength of what the scene is at single
/// wavelengths. It begins at rows of the material, the source and the sky, and takes at most kMostIntervals; what is
/// left of its error is in the estimates. Only results that are not an integral over the wavelength (the bracket, a
/// limit at 90 degrees) come from the spectral rule.
std::vector<PointResult> integrate_band(const SceneValues& scene, const SceneEntries& points, ModelEvaluator& evaluator,
                                        const Progress& progress);

}  // namespace dolp
