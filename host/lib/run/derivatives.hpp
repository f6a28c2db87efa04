// Derivatives of results by numbers of the scene.
#pragma once

#include <dolp/errors.hpp>
#include <dolp/results.hpp>
#include <span>
#include <string>
#include <vector>

#include "model/evaluator.hpp"
#include "model/scene_entry.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// The columns of the derivatives by `keys`, with units and without values. Errors: InputError that begins with
/// "derivatives: " for a key that is no number of the scene, or appears twice.
std::vector<DerivativeColumn> scene_derivatives(const SceneValues& scene, const SceneEntries& entries,
                                                const std::vector<std::string>& keys);

/// Computes the kDerivativesPerKey columns of the derivatives by a number x of the scene. With D(h) = (f(x + h) - f(x -
/// h)) / (2 h), a derivative is (4 D(h / 2) - D(h)) / 3 with an error of order h^4. The four results come from scenes
/// in double precision with a tolerance of at most 1e-8. The stated error is the difference from D(h / 2), which errs
/// by the order h^2, plus what the bounds of the four results can contribute. Derivatives and error are NaN where a
/// step leaves the domain of the scene. Domain: scene_derivatives() accepts `key`. Errors: errors of the evaluator;
/// Cancelled.
void compute_derivatives(const SceneValues& scene, const SceneEntries& entries, const std::string& key,
                         ModelEvaluator& evaluator, const Progress& progress, std::span<DerivativeColumn> columns);

}  // namespace dolp
