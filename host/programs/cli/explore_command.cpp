#include "cli/commands.hpp"
#include "explore/files.hpp"
#include "explore/window/app.hpp"
#include "terminal/exit_status.hpp"

namespace dolp::cli {

int run_explore(const Options& options) {
  explore::ProgramOptions program{options.device, options.command_line,    options.measured_path,
                                  options.frames, options.screenshot_path, options.panel};
  const bool is_session = explore::is_session_file(options.scene_path);
  if (is_session) {
    program.session_path = options.scene_path;
    program.settings = all_settings(options);
  }
  const std::vector<Setting> settings = is_session ? std::vector<Setting>{} : all_settings(options);
  explore::run_program(options.scene_path.empty() || is_session
                           ? Scene::from_text(example_scene(), settings, "stainless_steel")
                           : load_scene(options),
                       program);
  return kExitDone;
}

}  // namespace dolp::cli
