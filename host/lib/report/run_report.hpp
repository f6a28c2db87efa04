#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/evaluator.hpp"
#include "plan/effects.hpp"
#include "report/report.hpp"
#include "run/estimates.hpp"
#include "run/scene_run.hpp"
#include "scene/scene.hpp"

namespace dolp {

inline constexpr const char* kModelInaccurateText =
    "single scattering, or a masking that creates light, changes I by an estimated more than 5 %";

/// The report of a run. `gap`: result of scattering_gap(). `shape`: the shape of the grid, or for example "200 points".
/// `path`: the file that was written.
ReportBuilder run_report(const SceneValues& scene, const RunOutcome& run, const std::optional<ScatteringGap>& gap,
                         const std::string& shape, const std::string& path);

void add_evaluation(ReportBuilder& report, const EvaluationReport& evaluation, double wall_s);

/// The report of `dolp plan` for the scene's grid. `device`: position or part of a name. If it is empty, the report is
/// for the default device or, without a usable device, for the lowest limits that Vulkan allows. Errors: InputError of
/// grid_entries; DeviceError if a named device is not usable.
ReportBuilder plan_report(const SceneValues& scene, const std::string& device, EffectPlan plan);

/// The shape of a grid, for example "91 x 32 x 5 (theta x sigma x q)". Axes that the grid lacks are left out.
std::string grid_text(const Axes& grid);

/// The names and reasons of all effects, in four lists: kept, dropped, not needed and absent effects.
ReportBuilder::Json effects_json(const std::vector<Effect>& effects, const EffectPlan& plan);

}  // namespace dolp
