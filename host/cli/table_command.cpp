#include <fmt/format.h>

#include <chrono>

#include "base/stopwatch.hpp"
#include "cli/commands.hpp"
#include "cli/report.hpp"
#include "run/scene_table.hpp"
#include "table/table_file.hpp"
#include "terminal/exit_status.hpp"
#include "terminal/progress_bar.hpp"

namespace dolp::cli {

int run_table(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  check_output_is_no_input(options);
  const Scene scene = load_scene(options);
  check_output_path(options.output_path);
  const SceneEntries entries = grid_entries(scene);
  const EffectPlan plan = plan_run(options, scene, entries);
  const bool integrates = wants_evaluator(scene, entries, plan);
  const std::unique_ptr<MomentsEvaluator> evaluator = integrates ? make_evaluator(options, scene) : nullptr;
  std::vector<PointResult> results;
  {
    ProgressBar bar(options.quiet);
    results = evaluate_scene(scene, entries, plan, evaluator.get(), bar.callback());
  }
  const double wall_s = seconds_since(start);
  RunReport report = make_report(scene, entries, results, plan, report_of(evaluator.get(), options), wall_s);
  report.output = options.output_path;
  report.shape = fmt::format("{} x {} x {} (theta x sigma x q)", scene.grid.theta_deg.size(), scene.grid.sigma.size(),
                             scene.grid.q.size());
  const TableContent content{
      scene, results, plan, report.effects, report.evaluation, report.wall_s, options.command_line};
  write_table(scene_table(content), options.output_path);
  print_report(report, options.json, options.quiet);
  return options.strict && report.missed_tolerance > 0 ? kExitAccuracy : kExitDone;
}

}  // namespace dolp::cli
