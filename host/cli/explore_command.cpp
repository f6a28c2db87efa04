#include <fmt/format.h>

#include <filesystem>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "cli/commands.hpp"
#include "explore/window/app.hpp"
#include "scene/embedded_data.hpp"
#include "scene/text.hpp"
#include "terminal/exit_status.hpp"

namespace dolp::cli {
namespace {

constexpr const char* kBuiltInName = "stainless_steel.toml";

explore::SceneEdits load(const Options& options) {
  const bool is_built_in = options.scene_path.empty();
  std::string text = is_built_in ? std::string(embedded_stainless_steel_toml())
                                 : read_text(options.scene_path, input_name(options.scene_path) + ": ");
  return {std::move(text), is_built_in ? kBuiltInName : options.scene_path, all_overrides(options)};
}

}  // namespace

int run_explore(const Options& options) {
  explore::SceneEdits edits = load(options);
  if (!options.screenshot_path.empty() && options.frames == 0) {
    throw InputError("--screenshot needs --frames N beside it: the picture is of the last frame");
  }
  if (!options.screenshot_path.empty()) check_writable(options.screenshot_path);
  explore::AppOptions app_options;
  app_options.device = options.device;
  const std::string stem = std::filesystem::path(options.scene_path).stem().string();
  app_options.file_name = stem.empty() || stem == "-" ? "dolp" : stem;
  app_options.command_line = options.command_line;
  explore::App app(std::move(edits), app_options);
  if (!options.measured_path.empty()) {
    app.session().load_measured(options.measured_path);
    if (app.session().message().is_error) throw InputError(app.session().message().text);
  }
  if (options.frames == 0) {
    app.run();
  } else {
    fmt::print("{}", explore::summary_of(app.run_frames(options.frames, options.screenshot_path)));
  }
  return kExitDone;
}

}  // namespace dolp::cli
