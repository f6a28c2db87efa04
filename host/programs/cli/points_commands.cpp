#include "cli/commands.hpp"
#include "terminal/progress_bar.hpp"

namespace dolp::cli {

int run_eval(const Options& options) {
  const Scene scene = load_scene(options);
  const Report report = evaluator_of(options).write_points(scene, options.points_path, options.output_path,
                                                           {options.keep_all, ProgressBar(options.quiet).callback()});
  return finish(report, options);
}

int run_mueller(const Options& options) {
  const Scene scene = load_scene(options);
  const Report report = evaluator_of(options).write_mueller(scene, options.points_path, options.output_path,
                                                            {.progress = ProgressBar(options.quiet).callback()});
  return finish(report, options);
}

int run_lookup(const Options& options) {
  const Report report =
      write_lookup(options.table_path, options.points_path, options.output_path, ProgressBar(options.quiet).callback());
  return finish(report, options);
}

}  // namespace dolp::cli
