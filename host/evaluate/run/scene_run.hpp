// A scene at many entries: which moments are wanted, their evaluation, and the radiometry of each entry.
#pragma once

#include <optional>
#include <vector>

#include "evaluate/moments.hpp"
#include "evaluate/radiometry/radiometry.hpp"
#include "scene/points.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// One point of a table or of a list of points. Without an `index` of its own it has the scene's material.
struct SceneEntry {
  double theta_deg = 0.0;
  SlopeShape shape;
  std::optional<OpticalConstants> index;
};

/// The product of the scene's grid axes in C order (theta, sigma, q), q fastest.
/// Errors: InputError for more than 2^24 entries.
std::vector<SceneEntry> grid_entries(const Scene& scene);

/// Scattered points; what they do not say comes from the scene.
/// Errors: InputError that names the points' file and line, column, value and what is allowed: theta_deg is neither in
/// the points nor a single value in the grid; n without k, or k without n, beside a material that depends on the
/// wavelength; q <= 3/2 with smith masking and the cauchy distribution.
std::vector<SceneEntry> point_entries(const Scene& scene, const Points& points);

/// Refuses a q of the points that the scene's masking is not made for: q <= 3/2 with smith and the cauchy distribution;
/// the scene's own q has passed the same check.
/// Errors: InputError that names the points' file and line, column, value and what is allowed.
void check_smith(const Scene& scene, const Points& points);

/// Results in the order of `entries`. Progress counts entries.
/// Errors: those of the evaluator and of Radiometry.
std::vector<PointResult> evaluate_scene(const Scene& scene, const std::vector<SceneEntry>& entries,
                                        MomentsEvaluator& evaluator, const Progress& progress);

}  // namespace dolp
