// Report on a run over a scene's entries, and the parts that all run reports share.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <dolp/results.hpp>
#include "model/evaluator.hpp"
#include "plan/effects.hpp"
#include "report/plan_report.hpp"
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

}  // namespace dolp
