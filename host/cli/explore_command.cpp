#include "cli/commands.hpp"
#include "explore/program/program.hpp"
#include "terminal/exit_status.hpp"

namespace dolp::cli {

int run_explore(const Options& options) {
  explore::run_program({options.scene_path, all_overrides(options), options.device, options.command_line,
                        options.measured_path, options.frames, options.screenshot_path});
  return kExitDone;
}

}  // namespace dolp::cli
