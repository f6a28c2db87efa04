#include "cli/commands.hpp"
#include "explore/window/app.hpp"
#include "terminal/exit_status.hpp"

namespace dolp::cli {

int run_explore(const Options& options) {
  const Scene scene = options.scene_path.empty()
                          ? Scene::from_text(example_scene(), all_settings(options), "stainless_steel")
                          : load_scene(options);
  explore::run_program(scene, {options.device, options.command_line, options.measured_path, options.frames,
                               options.screenshot_path, options.panel});
  return kExitDone;
}

}  // namespace dolp::cli
