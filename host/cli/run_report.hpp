// A run of a scene's entries as `table` and `eval` make it, and what commands report of runs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "model/point_result.hpp"
#include "plan/effects.hpp"
#include "report/plan_report.hpp"
#include "report/report.hpp"
#include "run/run_summary.hpp"
#include "scene/points.hpp"
#include "table/result_csv.hpp"

namespace dolp::cli {

/// A finished run, for its report.
struct SceneRun {
  EffectPlan plan;
  std::vector<EffectRow> effects;
  RunSummary summary;
  std::optional<double> scattering_gap;  ///< none where it does not apply
  EvaluationReport evaluation;
  double wall_s = 0.0;
};

/// What ran: nothing, where no evaluator was needed.
EvaluationReport evaluation_of(const MomentsEvaluator* evaluator, const Options& options);

/// Prints the report of a run; returns the exit status. `shape`: that of the grid, or "200 points"; `path`: what was
/// written.
int report_run(const Options& options, const Scene& scene, const SceneRun& run, const std::string& shape,
               const std::string& path);

/// The columns of the points as they were given, and those of their results.
std::string result_csv(const Points& points, const std::vector<PointResult>& results, const ExtraColumns& extra);

/// Where a run was evaluated, and how long it took.
void add_evaluation(Report& report, const EvaluationReport& evaluation, double wall_s);

/// The results that carry a bit of the status.
std::size_t count_status(const std::vector<PointResult>& results, std::uint32_t bit);

/// The largest of an error that results state, of those whose status has none of `refused`; none without any.
std::optional<double> worst_of(const std::vector<PointResult>& results, double PointResult::*error,
                               std::uint32_t refused);

}  // namespace dolp::cli
