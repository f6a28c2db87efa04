#include "cli/commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <dolp/errors.hpp>
#include <optional>
#include <string>

#include "base/text.hpp"
#include "explore/files.hpp"
#include "explore/window/app.hpp"
#include "terminal/embedded_texts.hpp"
#include "terminal/terminal.hpp"

namespace dolp::cli {
namespace {

/// Errors: InputError if two inputs would read stdin.
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

/// The settings of the options --set, --tolerance and --precision, in this order. Errors: InputError.
std::vector<Setting> all_settings(const Options& options) {
  std::vector<Setting> settings = settings_from_text(options.overrides, "--set");
  const auto add = [&](const char* key, const std::string& option, const std::string& value) {
    if (!value.empty()) settings.push_back({key, TomlText{value}, one_line(option + ' ' + value)});
  };
  add("accuracy.tolerance", "--tolerance", options.tolerance);
  add("accuracy.precision", "--precision", options.precision);
  return settings;
}

/// Reads the scene, and applies all_settings() and then `more`. Prints Scene::remarks() as warnings on stderr.
Scene load_scene(const Options& options, const std::vector<Setting>& more = {}) {
  check_one_stdin(options);
  std::vector<Setting> settings = all_settings(options);
  settings.insert(settings.end(), more.begin(), more.end());
  const Scene scene = Scene::from_file(options.scene_path, settings);
  warn("dolp", scene.remarks());
  return scene;
}

/// Makes the evaluator that --evaluator names; without the option, the evaluator of the scene's table, or "vulkan".
/// Errors: InputError if it uses no device but the user gives --device.
Evaluator make_evaluator(const Options& options, const Scene& scene) {
  const bool needs_vulkan = !options.device.empty();
  const std::string fallback = needs_vulkan ? "vulkan" : scene.evaluator();
  const std::string evaluator = options.evaluator.empty() ? fallback : options.evaluator;
  if (needs_vulkan && evaluator != "vulkan") {
    throw InputError(fmt::format("--device {}: needs --evaluator vulkan, and it is {}", options.device, evaluator));
  }
  return Evaluator({evaluator, options.device});
}

std::size_t whole_number(const std::string& text, const std::string& what) {
  constexpr double kMost = 1e9;
  const std::optional<double> number = parse_number(text);
  if (number && *number >= 0.0 && *number <= kMost && *number == static_cast<double>(static_cast<std::size_t>(*number)))
    return static_cast<std::size_t>(*number);
  throw InputError(fmt::format("{}: {} is not a whole number from 0 to {}", what, one_line(text), kMost));
}

std::size_t slurm_number(const char* variable) {
  const char* text = std::getenv(variable);
  if (!text)
    throw InputError(fmt::format("--shard auto: needs the tasks of a Slurm array, and {} is not set", variable));
  return whole_number(text, variable);
}

/// The part of a table that --shard names: "2/8" is the second of eight parts; "auto" takes both numbers from Slurm.
Shard parse_shard(const std::string& text) {
  if (text.empty()) return {};
  Shard shard;
  if (text == "auto") {
    const std::size_t task = slurm_number("SLURM_ARRAY_TASK_ID");
    const std::size_t first = slurm_number("SLURM_ARRAY_TASK_MIN");
    shard = {task - first + 1, slurm_number("SLURM_ARRAY_TASK_COUNT")};
  } else {
    const std::size_t slash = text.find('/');
    if (slash == std::string::npos) throw InputError(fmt::format("--shard {}: must be I/N or auto", one_line(text)));
    shard = {whole_number(text.substr(0, slash), "--shard"), whole_number(text.substr(slash + 1), "--shard")};
  }
  if (shard.is_none()) throw InputError("--shard 0/0: there is no such shard");
  return shard;
}

std::vector<std::string> names_in(const std::string& list) {
  std::vector<std::string> names;
  if (list.empty()) return names;
  for (const std::string_view name : split(list, ',')) names.emplace_back(trim(name));
  return names;
}

int evaluate_points(const Scene& scene, const Options& options) {
  const Report report = make_evaluator(options, scene)
                            .write_points(scene, options.points_path, options.output_path,
                                          {.keep_all = options.keep_all,
                                           .progress = ProgressBar(options.quiet).callback(),
                                           .derivatives = names_in(options.derivatives)});
  return finish(report, options);
}

/// Does what the options of `dolp verify` ask for.
Report verification(const Options& options, const Progress& progress) {
  if (options.between > 0)
    return verify_between(options.table_path, {options.between, options.seed, names_in(options.quantities), progress});
  if (!options.hard_cases)
    return verify(options.table_path, {options.samples, options.seed, options.named_files, progress});
  DeviceCheckOptions check{options.evaluator.empty() ? "vulkan" : options.evaluator, options.device};
  if (!options.precision.empty()) check.precision = options.precision;
  if (!options.tolerance.empty()) {
    const std::optional<double> tolerance = parse_number(options.tolerance);
    if (!tolerance) {
      throw InputError(
          fmt::format("--tolerance {}: must be {}", one_line(options.tolerance), allowed("accuracy.tolerance")));
    }
    check.tolerance = *tolerance;
  }
  check.all = options.all;
  check.progress = progress;
  return verify_device(check);
}

}  // namespace

std::string allowed(const std::string& key) { return std::ranges::find(dolp::keys(), key, &Key::key)->allowed(); }

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

int run_table(const Options& options) {
  const Scene scene = load_scene(options);
  const Shard shard = parse_shard(options.shard);
  const Report report = make_evaluator(options, scene)
                            .write_table(scene, options.output_path,
                                         {options.keep_all, ProgressBar(options.quiet).callback(), options.command_line,
                                          options.resume, names_in(options.quantities), names_in(options.derivatives)},
                                         shard);
  return finish(report, options);
}

int run_response(const Options& options) {
  const Scene scene = load_scene(options, surface_settings());
  return finish(
      make_evaluator(options, scene)
          .write_response(scene, options.output_path,
                          {.progress = ProgressBar(options.quiet).callback(), .history = options.command_line}),
      options);
}

int run_merge(const Options& options) {
  return finish(merge({options.shards.begin(), options.shards.end()}, options.output_path, options.command_line),
                options);
}

int run_eval(const Options& options) { return evaluate_points(load_scene(options), options); }

int run_mueller(const Options& options) {
  const Scene scene = load_scene(options);
  const Report report = make_evaluator(options, scene)
                            .write_mueller(scene, options.points_path, options.output_path,
                                           {.progress = ProgressBar(options.quiet).callback()});
  return finish(report, options);
}

int run_lookup(const Options& options) {
  const Scene scene = load_scene(options);
  if (scene.table_attributes().empty())
    throw InputError(options.scene_path + ": is a scene and no table; dolp eval computes points of a scene");
  return evaluate_points(scene.for_points(), options);
}

int run_verify(const Options& options) {
  if (!options.hard_cases && options.table_path.empty()) {
    throw InputError("verify: name a TABLE, or --hard-cases to examine a device (see dolp verify --help)");
  }
  const Report report = verification(options, ProgressBar(options.quiet).callback());
  print(report, options);
  return report.is_good ? kExitDone : kExitAccuracy;
}

int run_plan(const Options& options) {
  return finish(plan(load_scene(options), options.device, options.keep_all), options);
}

int run_fit(const Options& options) {
  const Scene scene = load_scene(options);
  std::vector<MeasuredData> data;
  for (const std::string& argument : options.data) {
    data.push_back(MeasuredData::read(argument));
    warn("dolp", data.back().remarks);
  }
  FitOptions fit;
  for (const std::string& argument : options.vary) fit.vary.push_back(FitRange::from_text(argument));
  for (const std::string& argument : options.compare) fit.compare.push_back(Comparison::from_text(argument));
  fit.starts = options.starts;
  fit.seed = options.seed;
  fit.loss = static_cast<Loss>(std::ranges::find(loss_names(), options.loss) - loss_names().begin());
  fit.model_error = static_cast<ModelError>(std::ranges::find(model_error_names(), options.model_error) -
                                            model_error_names().begin());
  fit.output = options.output_path;
  fit.plot = options.plot_path;
  Report report;
  bool has_minimum = false;
  {
    ProgressBar bar(options.quiet);
    fit.progress = bar.callback();
    fit.phase = [&bar](const std::string& what) { bar.count(what); };
    const Fit found = make_evaluator(options, scene).fit(scene, data, fit);
    report = found.report;
    has_minimum = found.has_minimum;
  }
  const int status = finish(report, options);
  return has_minimum ? status : kExitAccuracy;
}

int run_explore(const Options& options) {
  explore::ProgramOptions program{{options.device, options.command_line},
                                  options.measured_path,
                                  options.frames,
                                  options.screenshot_path,
                                  options.panel};
  const bool is_session = explore::is_session_file(options.scene_path);
  if (is_session) {
    program.session_path = options.scene_path;
    program.settings = all_settings(options);
  }
  const std::vector<Setting> settings = is_session ? std::vector<Setting>{} : all_settings(options);
  explore::run_program(options.scene_path.empty() || is_session
                           ? Scene::from_text(std::string(embedded_night_paint_toml()), settings, "night_paint")
                           : load_scene(options),
                       program);
  return kExitDone;
}

}  // namespace dolp::cli
