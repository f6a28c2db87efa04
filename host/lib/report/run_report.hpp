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

/// The report of a run. `shape`: the shape of the grid, or "200 points". `path`: the file that was written. `gap`: how
/// wrong single scattering may be; empty if this does not apply to the scene.
ReportBuilder run_report(const SceneValues& scene, const RunOutcome& run, const std::optional<ScatteringGap>& gap,
                         const std::string& shape, const std::string& path);

void add_evaluation(ReportBuilder& report, const EvaluationReport& evaluation, double wall_s);

/// The report of a planned run over the scene's grid. `device`: position or part of a name. If it is empty, the default
/// device is used or, without any usable device, limits that every device keeps.
/// Errors: InputError of grid_entries; DeviceError if a named device is not usable.
ReportBuilder plan_report(const SceneValues& scene, const std::string& device, EffectPlan plan);

/// The shape of a grid, for example "91 x 32 x 5 (theta x sigma x q)". Axes that the grid lacks are left out.
std::string grid_text(const Axes& grid);

/// The names and reasons of all effects, in one list each for kept, dropped, not needed and absent effects.
ReportBuilder::Json effects_json(const std::vector<Effect>& effects, const EffectPlan& plan);

}  // namespace dolp
