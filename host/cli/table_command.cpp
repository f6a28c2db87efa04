#include "cli/commands.hpp"
#include "cli/run_report.hpp"
#include "cli/scene_table.hpp"
#include "evaluate/run/scene_run.hpp"
#include "table/table_file.hpp"

namespace dolp::cli {

int run_table(const Options& options) {
  const Stopwatch watch;
  check_output_is_no_input(options);
  const Scene scene = load_scene(options);
  check_output_path(options.output_path);
  const std::vector<SceneEntry> entries = grid_entries(scene);
  const SceneRun run = run_entries(options, scene, entries, watch);
  const TableContent content{scene,      run.results,         run.plan, run.effects, run.evaluation,
                             run.wall_s, options.command_line};
  write_table(scene_table(content), options.output_path);
  return report_run(options, scene, entries, run, grid_text(scene.grid));
}

}  // namespace dolp::cli
