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
    "light that single scattering loses, or that the masking creates, changes I or DOLP by an estimated more than 5 %";

/// "... changes I by up to about 6 % and DOLP by up to about 1.2 points"
std::string model_change_text(const ModelChange& change);

/// What direct emission leaves out, as a row of the report.
void add_direct_emission(ReportBuilder& report, const SceneModel& scene, const ModelChange& change);

/// The report of a run that wrote `path`. `gap`: result of scattering_gap(). `shape`: for example "200 points".
ReportBuilder run_report(const SceneValues& scene, const RunOutcome& run, const std::optional<ScatteringGap>& gap,
                         const std::string& shape, const std::string& path);

/// Adds the title of the scene, and the settings that a call gave and that the title may contradict.
void add_title(ReportBuilder& report, const SceneValues& scene);

/// The errors of a device's float operations, and their effect on error bounds.
std::string arithmetic_text(const Arithmetic& arithmetic);
ReportBuilder::Json arithmetic_json(const Arithmetic& arithmetic);

void add_evaluation(ReportBuilder& report, const EvaluationReport& evaluation, double wall_s);

/// The report of `dolp plan` for the scene's grid. `device` is the position of a device or a part of its name. If it is
/// empty, the report is for the best device or, if no device is usable, for the lowest limits that Vulkan allows.
/// Errors: errors of grid_entries; DeviceError if the named device is not usable.
ReportBuilder plan_report(const SceneValues& scene, const std::string& device, EffectPlan plan);

std::string grid_text(const Axes& grid);

ReportBuilder::Json effects_json(const std::vector<Effect>& effects, const EffectPlan& plan);

}  // namespace dolp
