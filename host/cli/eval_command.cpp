#include <fmt/format.h>

#include <chrono>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "cli/commands.hpp"
#include "cli/report.hpp"
#include "scene/points.hpp"
#include "table/result_csv.hpp"
#include "terminal/exit_status.hpp"
#include "terminal/progress_bar.hpp"

namespace dolp::cli {

int run_eval(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  check_one_stdin(options);
  check_output_is_no_input(options);
  const Scene scene = load_scene(options);
  const Points points = read_points(options.points_path, PointsKind::kDirections);
  const SceneEntries entries = point_entries(scene, points);
  check_writable(options.output_path);
  const EffectPlan plan = plan_run(options, scene, entries);
  const bool integrates = wants_evaluator(scene, entries, plan);
  const std::unique_ptr<MomentsEvaluator> evaluator = integrates ? make_evaluator(options, scene) : nullptr;
  std::vector<PointResult> results;
  {
    ProgressBar bar(options.quiet);
    results = evaluate_scene(scene, entries, plan, evaluator.get(), bar.callback());
  }
  std::string csv = points.header + ',' + kResultColumns + '\n';
  for (std::size_t i = 0; i < results.size(); ++i) csv += points.rows[i] + ',' + result_cells(results[i]) + '\n';
  const double wall_s = seconds_since(start);
  RunReport report = make_report(scene, entries, results, plan, report_of(evaluator.get(), options), wall_s);
  report.output = options.output_path;
  report.shape = fmt::format("{} points", results.size());
  write_text_atomically(options.output_path, csv);
  print_report(report, options.json, options.quiet);
  return options.strict && report.missed_tolerance > 0 ? kExitAccuracy : kExitDone;
}

}  // namespace dolp::cli
