#include <chrono>
#include <memory>

#include "base/atomic_file.hpp"
#include "base/stopwatch.hpp"
#include "cli/commands.hpp"
#include "cli/run_report.hpp"
#include "run/scattering_gap.hpp"
#include "run/scene_run.hpp"
#include "run/scene_table.hpp"
#include "terminal/progress_bar.hpp"

namespace dolp::cli {

int run_eval(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  check_one_stdin(options);
  const Scene scene = load_scene(options);
  check_output_is_no_input(options, scene.files);
  const Points points = load_points(options, PointsKind::kDirections);
  const SceneEntries entries = point_entries(scene, points);
  check_writable(options.output_path);
  SceneRun run;
  run.plan = plan_effects(scene, entries, options.keep_all);
  const bool integrates = wants_evaluator(scene, entries, run.plan);
  const std::unique_ptr<MomentsEvaluator> evaluator = integrates ? make_evaluator(options, scene) : nullptr;
  CollectedResults collected(entries);
  {
    ProgressBar bar(options.quiet);
    run.summary.check = run_scene(scene, entries, run.plan, evaluator.get(), collected, bar.callback());
  }
  const std::vector<PointResult> results = collected.take();
  run.summary.add(scene, entries, results);
  run.evaluation = evaluation_of(evaluator.get(), options);
  run.scattering_gap = scattering_gap(scene, entries, run.plan);
  run.effects = effect_rows(scene, entries, run.plan);
  write_text_atomically(options.output_path, result_csv(points, results, extra_columns(scene)));
  run.wall_s = seconds_since(start);
  return report_run(options, scene, run, fmt::format("{} points", results.size()), options.output_path);
}

}  // namespace dolp::cli
