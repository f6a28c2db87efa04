#include <chrono>

#include "base/stopwatch.hpp"
#include "cli/commands.hpp"
#include "cli/run_report.hpp"
#include "run/scene_run.hpp"
#include "run/scene_table.hpp"
#include "table/table_file.hpp"

namespace dolp::cli {

int run_table(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  const Scene scene = load_scene(options);
  check_output_is_no_input(options, scene.files);
  check_output_path(options.output_path);
  const SceneEntries entries = grid_entries(scene);
  SceneRun run = run_entries(options, scene, entries, start);
  const TableContent content{scene,          run.results, run.plan,   run.effects,
                             run.evaluation, run.check,   run.wall_s, options.command_line};
  write_table(scene_table(content), options.output_path);
  run.wall_s = seconds_since(start);
  return report_run(options, scene, entries, run, grid_text(scene.grid));
}

}  // namespace dolp::cli
