// A scene at many entries: which moments are wanted, their evaluation, and the radiometry of each entry.
#pragma once

#include <span>
#include <vector>

#include "evaluate/evaluator.hpp"
#include "model/point_result.hpp"
#include "model/scene_entry.hpp"
#include "plan/effects.hpp"
#include "scene/points.hpp"
#include "scene/scene.hpp"

namespace dolp {

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

/// How a run cuts its entries, which bounds its memory: consecutive blocks, each with requests of its own.
std::vector<std::span<const SceneEntry>> run_blocks(std::span<const SceneEntry> entries, std::size_t spectral_samples);

/// Whether anything is left for an evaluator: the plan needs moments or beams, and not all entries have closed forms.
bool wants_evaluator(const Scene& scene, std::span<const SceneEntry> entries, const EffectPlan& plan);

/// Results in the order of `entries`, of what the plan keeps; what that does not give is NaN. Progress counts entries.
/// The evaluator may be null where wants_evaluator says so.
/// Errors: those of the evaluator and of Radiometry.
std::vector<PointResult> evaluate_scene(const Scene& scene, const std::vector<SceneEntry>& entries,
                                        const EffectPlan& plan, MomentsEvaluator* evaluator, const Progress& progress);

/// The same with everything kept.
std::vector<PointResult> evaluate_scene(const Scene& scene, const std::vector<SceneEntry>& entries,
                                        MomentsEvaluator& evaluator, const Progress& progress);

}  // namespace dolp
