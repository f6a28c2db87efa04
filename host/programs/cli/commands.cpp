#include "cli/commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <dolp/errors.hpp>
#include <optional>
#include <string>

#include "base/text.hpp"
#include "explore/files.hpp"
#include "explore/window/app.hpp"
#include "terminal/embedded_texts.hpp"
#include "terminal/exit_status.hpp"
#include "terminal/guarded.hpp"
#include "terminal/progress_bar.hpp"

namespace dolp::cli {
namespace {

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

Report verify_device(const Options& options, const Progress& progress) {
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

int evaluate_points(const Scene& scene, const Options& options) {
  const Report report = make_evaluator(options, scene)
                            .write_points(scene, options.points_path, options.output_path,
                                          {.keep_all = options.keep_all,
                                           .progress = ProgressBar(options.quiet).callback(),
                                           .derivatives = names_in(options.derivatives)});
  return finish(report, options);
}

Report verification(const Options& options, const Progress& progress) {
  if (options.hard_cases) return verify_device(options, progress);
  if (options.between == 0)
    return dolp::verify(options.table_path, {options.samples, options.seed, options.named_files, progress});
  return verify_between(options.table_path, {options.between, options.seed, names_in(options.quantities), progress});
}

}  // namespace

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
