// Reports on a run and on a planned run, and the parts that several reports share.
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

/// The report of a run. `shape`: the shape of the grid, or "200 points"; `path`: the file that was written; `gap`: how
/// far single scattering may be off, none where this does not apply.
ReportBuilder run_report(const SceneValues& scene, const RunOutcome& run, const std::optional<ScatteringGap>& gap,
                         const std::string& shape, const std::string& path);

/// The evaluator and device of a run, and the time that it took.
void add_evaluation(ReportBuilder& report, const EvaluationReport& evaluation, double wall_s);

/// The report of a run of `plan` over the scene's grid. `device`: a position or a part of a name; empty is the default
/// device, or the limits that every device keeps where there is none.
/// Errors: InputError of grid_entries; DeviceError where a named device is not usable.
ReportBuilder plan_report(const SceneValues& scene, const std::string& device, EffectPlan plan);

/// "91 x 32 x 5 (theta x sigma x q)"; an axis that the grid lacks is left out.
std::string grid_text(const Axes& grid);

/// Names and reasons of the effects that are kept, dropped, not needed and absent.
ReportBuilder::Json effects_json(const std::vector<Effect>& effects, const EffectPlan& plan);

}  // namespace dolp
