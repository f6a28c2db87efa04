#include <chrono>

#include "base/atomic_file.hpp"
#include "base/stopwatch.hpp"
#include "cli/commands.hpp"
#include "cli/run_report.hpp"
#include "run/scene_run.hpp"
#include "run/scene_table.hpp"

namespace dolp::cli {

int run_eval(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  check_one_stdin(options);
  const Scene scene = load_scene(options);
  check_output_is_no_input(options, scene.files);
  const Points points = read_points(options.points_path, PointsKind::kDirections);
  const SceneEntries entries = point_entries(scene, points);
  check_writable(options.output_path);
  SceneRun run = run_entries(options, scene, entries, start);
  write_text_atomically(options.output_path, result_csv(points, run.results, extra_columns(scene)));
  run.wall_s = seconds_since(start);
  return report_run(options, scene, entries, run, fmt::format("{} points", run.results.size()));
}

}  // namespace dolp::cli
