#include "cli/commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <dolp/errors.hpp>

#include "base/text.hpp"
#include "terminal/exit_status.hpp"
#include "terminal/guarded.hpp"

namespace dolp::cli {

void check_one_stdin(const Options& options) {
  const auto is_stdin = [](const std::string& data) { return data == "-" || data.starts_with("-:"); };
  const bool is_scene = options.scene_path == "-";
  if (is_scene && options.points_path == "-") {
    throw InputError("--points -: SCENE is - too, and stdin can be read only once; name a file for one of them");
  }
  if (std::ranges::count_if(options.data, is_stdin) + (is_scene ? 1 : 0) > 1) {
    throw InputError("--data -: stdin can be read only once; name a file for one of them");
  }
}

std::vector<Setting> all_settings(const Options& options) {
  std::vector<Setting> settings = settings_from_text(options.overrides, "--set");
  const auto add = [&](const char* key, const std::string& option, const std::string& value) {
    if (!value.empty()) settings.push_back({key, TomlText{value}, one_line(option + ' ' + value)});
  };
  add("accuracy.tolerance", "--tolerance", options.tolerance);
  add("accuracy.precision", "--precision", options.precision);
  return settings;
}

std::string allowed(const std::string& key) { return std::ranges::find(dolp::keys(), key, &Key::key)->allowed(); }

Scene load_scene(const Options& options, const std::vector<Setting>& more) {
  check_one_stdin(options);
  std::vector<Setting> settings = all_settings(options);
  settings.insert(settings.end(), more.begin(), more.end());
  const Scene scene = Scene::from_file(options.scene_path, settings);
  warn("dolp", scene.remarks());
  return scene;
}

Evaluator make_evaluator(const Options& options, const Scene& scene) {
  const bool needs_vulkan = !options.device.empty();
  const std::string fallback = needs_vulkan ? "vulkan" : scene.evaluator();
  const std::string evaluator = options.evaluator.empty() ? fallback : options.evaluator;
  if (needs_vulkan && evaluator != "vulkan") {
    throw InputError(fmt::format("--device {}: needs --evaluator vulkan, and it is {}", options.device, evaluator));
  }
  return Evaluator({evaluator, options.device});
}

void print(const Report& report, const Options& options) {
  std::FILE* const out = options.output_path == "-" ? stderr : stdout;
  if (options.json) {
    std::fputs((report.json + '\n').c_str(), out);
  } else if (!options.quiet) {
    std::fputs(report.text.c_str(), out);
  }
}

int finish(const Report& report, const Options& options) {
  warn("dolp", report.remarks);
  print(report, options);
  if (!options.strict || report.is_good) return kExitDone;
  return fail("dolp", kExitAccuracy, "--strict: the tolerance is not met everywhere");
}

}  // namespace dolp::cli
