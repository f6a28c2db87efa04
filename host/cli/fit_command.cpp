#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <limits>
#include <memory>
#include <string_view>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "cli/commands.hpp"
#include "cli/fit_picture.hpp"
#include "cli/run_report.hpp"
#include "model/status.hpp"
#include "report/fit_report.hpp"
#include "scene/scene_reader.hpp"
#include "scene/scene_writer.hpp"
#include "scene/text.hpp"
#include "terminal/exit_status.hpp"
#include "terminal/progress_bar.hpp"

namespace dolp::cli {
namespace {

using fit::FitResult;
using fit::Model;

fit::Loss loss_of(const std::string& name) {
  const auto found = std::ranges::find(fit::kLossNames, std::string_view(name));
  return static_cast<fit::Loss>(found - fit::kLossNames.begin());
}

/// All combinations of what --compare lists, one list of overrides each; one empty list without it.
std::vector<std::vector<std::string>> combinations(const std::vector<std::string>& compare,
                                                   const std::vector<fit::Parameter>& parameters) {
  std::vector<std::vector<std::string>> all = {{}};
  for (const std::string& argument : compare) {
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos || equals + 1 == argument.size()) {
      throw InputError(fmt::format("--compare {}: must be KEY=WORD,WORD,...", one_line(argument)));
    }
    const std::string key(trim(std::string_view(argument).substr(0, equals)));
    if (std::ranges::find(parameters, key, &fit::Parameter::key) != parameters.end()) {
      throw InputError(fmt::format("--compare {}: {} is varied and cannot be compared too", one_line(argument), key));
    }
    std::vector<std::vector<std::string>> more;
    for (const std::vector<std::string>& one : all) {
      for (const std::string_view word : split(std::string_view(argument).substr(equals + 1), ',')) {
        more.push_back(one);
        more.back().push_back(fmt::format("{}={}", key, trim(word)));
      }
    }
    all = std::move(more);
  }
  return all;
}

/// What the command line says, read.
struct Inputs {
  fit::SceneText scene;
  std::vector<fit::FitData> data;
  std::vector<fit::Parameter> parameters;
};

Inputs read_inputs(const Options& options) {
  const auto is_stdin = [](const std::string& data) { return data == "-" || data.starts_with("-:"); };
  if (std::ranges::count_if(options.data, is_stdin) + (options.scene_path == "-" ? 1 : 0) > 1) {
    throw InputError("--data -: stdin can be read only once; name a file for one of them");
  }
  Inputs inputs;
  inputs.scene = {read_text(options.scene_path, input_name(options.scene_path) + ": "), options.scene_path,
                  all_overrides(options)};
  for (const std::string& argument : options.data) inputs.data.push_back(fit::read_fit_data(argument));
  for (const std::string& argument : options.vary) inputs.parameters.push_back(fit::parse_parameter(argument));
  if (options.loss != fit::kLossNames.front()) {
    for (const fit::FitData& data : inputs.data) {
      if (data.has_uncertainties) continue;
      throw InputError(fmt::format("--loss {}: {} needs the column \"uncertainty\", which says what lies off",
                                   options.loss, data.name));
    }
  }
  return inputs;
}

void check_outputs(const Options& options, const Scene& scene) {
  std::vector<std::string> inputs = scene.files;
  for (const std::string& argument : options.data) inputs.push_back(argument.substr(0, argument.find(':')));
  if (!options.output_path.empty()) {
    check_output_is_no_input(options, inputs);
    check_writable(options.output_path);
  }
  if (options.plot_path.empty()) return;
  Options picture = options;
  picture.output_path = options.plot_path;
  check_output_is_no_input(picture, inputs);
  check_writable(options.plot_path);
}

/// The scene with what was compared and what was found.
void write_fitted(const Options& options, const fit::SceneText& scene, const Model& model, const FitResult& result) {
  if (options.output_path.empty()) return;
  Eigen::VectorXd values(static_cast<Eigen::Index>(result.parameters.size()));
  for (Eigen::Index j = 0; j < values.size(); ++j) values[j] = result.parameters[static_cast<std::size_t>(j)].value;
  std::vector<std::string> overrides = scene.overrides;
  std::ranges::copy(model.overrides(values), std::back_inserter(overrides));
  const std::filesystem::path folder = std::filesystem::path(options.output_path).parent_path();
  write_text_atomically(options.output_path, scene_toml(scene.text, scene.path_name, overrides, folder));
}

}  // namespace

int run_fit(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  const Inputs inputs = read_inputs(options);
  const std::vector<std::vector<std::string>> compared = combinations(options.compare, inputs.parameters);
  std::vector<ComparedModel> models;
  std::unique_ptr<MomentsEvaluator> evaluator;
  std::unique_ptr<Model> best_model;
  fit::SceneText best_scene;
  std::optional<FitResult> best;
  {
    ProgressBar bar(options.quiet);
    const fit::FitOptions fit_options{options.starts, options.seed, loss_of(options.loss), bar.callback()};
    for (const std::vector<std::string>& overrides : compared) {
      ComparedModel& one = models.emplace_back();
      one.overrides = overrides;
      fit::SceneText scene = inputs.scene;
      scene.overrides.insert(scene.overrides.end(), overrides.begin(), overrides.end());
      std::unique_ptr<Model> model;
      try {
        model = std::make_unique<Model>(scene, inputs.data, inputs.parameters);
      } catch (const InputError& error) {
        if (compared.size() == 1) throw;
        one.refusal = error.what();
        continue;
      }
      if (!evaluator) {
        check_outputs(options, model->scene());
        evaluator = make_evaluator(options, model->scene());
      }
      one.result = fit::fit(*model, *evaluator, fit_options);
      if (!one.result || (best && best->aic <= one.result->aic)) continue;
      best = one.result;
      best_model = std::move(model);
      best_scene = scene;
    }
  }
  if (!evaluator) throw InputError("--compare: " + models.front().refusal);
  std::ranges::stable_sort(models, {}, [](const ComparedModel& one) {
    return one.result ? one.result->aic : std::numeric_limits<double>::infinity();
  });

  Report report;
  report.line("{}", key("title", best ? best_model->scene().title : inputs.scene.path_name));
  if (best) {
    write_fitted(options, best_scene, *best_model, *best);
    report.row("data", "{} measured values of {} file{}", key("observations", best_model->observation_count()),
               inputs.data.size(), inputs.data.size() == 1 ? "" : "s");
    if (models.size() > 1) add_comparison(report, models);
    add_fit(report, *best_model, *best);
  } else {
    report.row("minimum", "none was found: no descent converged; try other ranges, or more --starts");
  }
  report.value("has_minimum", best.has_value());
  report.row("starts", "{} descents, seed {}", key("starts", options.starts), key("seed", options.seed));
  report.value("loss", options.loss);
  add_evaluation(report, evaluator->report(), seconds_since(start));
  report.value("integrand_evaluations", evaluator->report().evaluations);
  report.row_if(best && !options.output_path.empty(), "written", "{}", key("output", options.output_path));
  if (best && !options.plot_path.empty()) {
    report.row("picture", "{}", key("plot", options.plot_path));
    draw_fit(report.json().dump(-1, ' ', true, Report::Json::error_handler_t::replace), options.plot_path);
  }
  report.print(options.json, options.quiet, options.output_path);
  if (!best) return kExitAccuracy;
  return options.strict && (best->status & kStatusToleranceMissed) != 0 ? kExitAccuracy : kExitDone;
}

}  // namespace dolp::cli
