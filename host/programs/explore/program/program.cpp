#include "explore/program/program.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "base/atomic_file.hpp"
#include "explore/window/app.hpp"

namespace dolp::explore {

void run_program(const Scene& scene, const ProgramOptions& options) {
  if (!options.screenshot_path.empty() && options.frames == 0) {
    throw InputError("--screenshot needs --frames N beside it: the picture is of the last frame");
  }
  if (!options.screenshot_path.empty()) check_writable(options.screenshot_path);
  const std::string stem = std::filesystem::path(scene.name()).stem().string();
  App app(SceneEdits(scene), {options.device, stem.empty() || stem == "-" ? "dolp" : stem, options.command_line});
  if (!options.measured_path.empty()) {
    app.session().load_measured(options.measured_path);
    if (app.session().message().is_error) throw InputError(app.session().message().text);
  }
  if (options.frames == 0) {
    app.run();
  } else {
    fmt::print("{}", summary_of(app.run_frames(options.frames, options.screenshot_path)));
  }
}

}  // namespace dolp::explore
