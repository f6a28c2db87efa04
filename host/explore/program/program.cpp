#include "explore/program/program.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "explore/window/app.hpp"
#include "scene/embedded_data.hpp"

namespace dolp::explore {
namespace {

constexpr const char* kBuiltInName = "stainless_steel.toml";

SceneEdits load(const ProgramOptions& options) {
  const bool is_built_in = options.scene_path.empty();
  std::string text = is_built_in ? std::string(embedded_stainless_steel_toml())
                                 : read_text(options.scene_path, input_name(options.scene_path) + ": ");
  return {std::move(text), is_built_in ? kBuiltInName : options.scene_path, options.overrides};
}

}  // namespace

void run_program(const ProgramOptions& options) {
  SceneEdits edits = load(options);
  if (!options.screenshot_path.empty() && options.frames == 0) {
    throw InputError("--screenshot needs --frames N beside it: the picture is of the last frame");
  }
  if (!options.screenshot_path.empty()) check_writable(options.screenshot_path);
  const std::string stem = std::filesystem::path(options.scene_path).stem().string();
  App app(std::move(edits), {options.device, stem.empty() || stem == "-" ? "dolp" : stem, options.command_line});
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
