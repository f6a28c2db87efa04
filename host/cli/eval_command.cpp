#include "cli/commands.hpp"
#include "cli/result_csv.hpp"
#include "cli/run_report.hpp"
#include "evaluate/run/scene_run.hpp"
#include "table/atomic_file.hpp"

namespace dolp::cli {

int run_eval(const Options& options) {
  const Stopwatch watch;
  check_one_stdin(options);
  check_output_is_no_input(options);
  const Scene scene = load_scene(options);
  const Points points = read_points(options.points_path, PointsKind::kDirections);
  const std::vector<SceneEntry> entries = point_entries(scene, points);
  check_writable(options.output_path);
  const SceneRun run = run_entries(options, scene, entries, watch);
  write_text_atomically(options.output_path, result_csv(points, run.results));
  return report_run(options, scene, entries, run, fmt::format("{} points", run.results.size()));
}

}  // namespace dolp::cli
