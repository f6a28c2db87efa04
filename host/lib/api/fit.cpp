// Numbers of a scene from measured data.
#include "fit/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <limits>

#include "api/evaluator_impl.hpp"
#include "api/reports.hpp"
#include "api/scene_impl.hpp"
#include "base/atomic_file.hpp"
#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "fit/fit_data.hpp"
#include "model/status.hpp"
#include "report/fit_picture.hpp"
#include "report/fit_report.hpp"
#include "report/run_report.hpp"
#include "run/scene_run.hpp"
#include "scene/points.hpp"
#include "scene/scene_reader.hpp"
#include "scene/scene_writer.hpp"

namespace dolp::api {
namespace {

using Overrides = std::vector<std::string>;

fit::Loss loss_of(const std::string& name, const std::vector<fit::FitData>& data) {
  const auto found = std::ranges::find(fit::kLossNames, std::string_view(name));
  if (found == fit::kLossNames.end()) {
    throw dolp::InputError(fmt::format("loss {}: must be one of {}", one_line(name), fmt::join(fit::kLossNames, ", ")));
  }
  for (const fit::FitData& one : data) {
    if (found == fit::kLossNames.begin() || one.has_uncertainties) continue;
    throw dolp::InputError(
        fmt::format("--loss {}: {} needs the column \"uncertainty\", which says what lies off", name, one.name));
  }
  return static_cast<fit::Loss>(found - fit::kLossNames.begin());
}

/// All combinations of what `compare` lists, one list of overrides each; one empty list without it.
std::vector<Overrides> combinations(const std::vector<std::string>& compare,
                                    const std::vector<fit::Parameter>& parameters) {
  std::vector<Overrides> all = {{}};
  for (const std::string& argument : compare) {
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos || equals + 1 == argument.size()) {
      throw dolp::InputError(fmt::format("--compare {}: must be KEY=WORD,WORD,...", one_line(argument)));
    }
    const std::string key(trim(std::string_view(argument).substr(0, equals)));
    if (std::ranges::find(parameters, key, &fit::Parameter::key) != parameters.end()) {
      throw dolp::InputError(
          fmt::format("--compare {}: {} is varied and cannot be compared too", one_line(argument), key));
    }
    std::vector<Overrides> more;
    for (const Overrides& one : all) {
      for (const std::string_view word : split(std::string_view(argument).substr(equals + 1), ',')) {
        more.push_back(one);
        more.back().push_back(fmt::format("{}={}", key, trim(word)));
      }
    }
    all = std::move(more);
  }
  return all;
}

/// The best of the models that were compared.
struct Best {
  std::unique_ptr<fit::Model> model;
  std::optional<fit::FitResult> result;
  Overrides compared;

  /// What was compared, and the values that were found.
  Overrides overrides() const {
    const std::vector<fit::FittedParameter>& found = result.value().parameters;
    Eigen::VectorXd values(static_cast<Eigen::Index>(found.size()));
    for (Eigen::Index j = 0; j < values.size(); ++j) values[j] = found[static_cast<std::size_t>(j)].value;
    Overrides all = compared;
    std::ranges::copy(model->overrides(values), std::back_inserter(all));
    return all;
  }
};

void check_outputs(const FitOptions& options, const dolp::Scene& scene, const std::vector<MeasuredData>& data) {
  std::vector<std::string> inputs = files_of(scene);
  for (const MeasuredData& one : data) inputs.push_back(one.name);
  for (const std::filesystem::path& path : {options.output, options.plot}) {
    if (path.empty()) continue;
    check_output_is_no_input(path, inputs);
    check_writable(path);
  }
}

/// The bracket of the fitted model over zenith for each data set; null where the scene has none, or none of DOLP was
/// measured.
dolp::Report::Json brackets(const Scene& fitted, const std::vector<fit::FitData>& sets, MomentsEvaluator& evaluator) {
  dolp::Report::Json all = dolp::Report::Json::array();
  for (const fit::FitData& data : sets) {
    dolp::Report::Json& one = all.emplace_back(nullptr);
    const bool has_dolp = std::ranges::any_of(
        data.observations, [](const fit::Observation& o) { return o.observable == fit::Observable::kDolp; });
    if (!has_dolp) continue;
    Overrides overrides = fitted.overrides();
    std::ranges::copy(data.overrides, std::back_inserter(overrides));
    overrides.push_back("emission.bracket=true");
    try {
      const dolp::Scene scene = parse_scene(fitted.text(), fitted.name(), overrides);
      std::vector<double> theta_deg;
      for (const fit::Observation& o : data.observations) theta_deg.push_back(o.theta_deg);
      std::ranges::sort(theta_deg);
      const NamedColumn zeniths{"theta_deg", theta_deg};
      const Points points = points_of(std::span(&zeniths, 1), theta_deg.size(), PointsKind::kDirections);
      one["theta_deg"] = theta_deg;
      for (const PointResult& result : evaluate_scene(scene, point_entries(scene, points), evaluator, {})) {
        one["low"].push_back(result.dolp_low);
        one["high"].push_back(result.dolp_high);
      }
    } catch (const dolp::InputError&) {
      continue;  // a scene without a bracket
    }
  }
  return all;
}

FitInterval interval_of(const fit::Interval& interval) { return {interval.low, interval.high}; }

void add_numbers(Fit& found, const fit::FitResult& result) {
  for (const fit::FittedParameter& one : result.parameters) {
    found.parameters.push_back(
        {one.key, one.value, one.standard_error, interval_of(one.interval_68), interval_of(one.interval_95)});
  }
  found.chi_square = result.chi_square;
  found.degrees_of_freedom = result.degrees_of_freedom;
  found.p_value = result.p_value;
  found.other_minima = result.minima.size();
  found.degeneracies = result.degeneracies;
}

void write_fitted(const std::filesystem::path& path, const Scene& fitted) {
  write_text_atomically(path, scene_toml(fitted.text(), fitted.name(), fitted.overrides(), path.parent_path()));
}

}  // namespace

std::vector<std::string> fit_losses() { return {fit::kLossNames.begin(), fit::kLossNames.end()}; }

MeasuredData MeasuredData::read(const std::string& argument) {
  return translated([&] {
    const fit::DataArgument parts = fit::parse_data_argument(argument);
    return MeasuredData{read_text(parts.path, input_name(parts.path) + ": "), parts.overrides, parts.path};
  });
}

std::vector<Measurement> MeasuredData::measurements() const {
  return translated([&] {
    std::vector<Measurement> all;
    for (const fit::Observation& one : fit::parse_fit_data(csv, name).observations) {
      all.push_back({fit::name_of(one.observable), one.theta_deg, one.value, one.uncertainty, one.wavelength_um});
    }
    return all;
  });
}

Fit Evaluator::fit(const Scene& scene, const std::vector<MeasuredData>& data, const FitOptions& options) {
  return impl_->exclusively([&] {
    const auto start = std::chrono::steady_clock::now();
    const dolp::Scene& own = scene.impl().scene;
    std::vector<fit::FitData> sets;
    for (const MeasuredData& one : data) {
      sets.push_back(fit::parse_fit_data(one.csv, one.name));
      sets.back().overrides = one.overrides;
    }
    std::vector<fit::Parameter> parameters;
    for (const std::string& one : options.vary) parameters.push_back(fit::parse_parameter(one));
    const fit::FitOptions fit_options{options.starts, options.seed, loss_of(options.loss, sets), options.progress};

    begin(options.progress, 1);
    std::vector<ComparedModel> models;
    MomentsEvaluator* evaluator = nullptr;
    Best best;
    const std::vector<Overrides> compared = combinations(options.compare, parameters);
    for (const Overrides& overrides : compared) {
      ComparedModel& one = models.emplace_back();
      one.overrides = overrides;
      fit::SceneText text{own.text, own.path_name, own.overrides};
      std::ranges::copy(overrides, std::back_inserter(text.overrides));
      std::unique_ptr<fit::Model> model;
      try {
        model = std::make_unique<fit::Model>(text, sets, parameters);
      } catch (const dolp::InputError& error) {
        if (compared.size() == 1) throw;
        one.refusal = error.what();
        continue;
      }
      if (evaluator == nullptr) {
        check_outputs(options, model->scene(), data);
        evaluator = impl_->begin(model->scene());
      }
      one.result = fit::fit(*model, *evaluator, fit_options);
      if (one.result && (!best.result || one.result->aic < best.result->aic)) {
        best = {std::move(model), one.result, overrides};
      }
    }
    if (evaluator == nullptr) throw dolp::InputError("--compare: " + models.front().refusal);
    std::ranges::stable_sort(models, {}, [](const ComparedModel& one) {
      return one.result ? one.result->aic : std::numeric_limits<double>::infinity();
    });

    dolp::Report report;
    report.line("{}", key("title", own.title));
    if (best.result) {
      report.row("data", "{} measured values of {} file{}", key("observations", best.model->observation_count()),
                 sets.size(), sets.size() == 1 ? "" : "s");
      if (models.size() > 1) add_comparison(report, models);
      add_fit(report, *best.model, *best.result);
    } else {
      report.row("minimum", "none was found: no descent converged; try other ranges, or more starts");
    }
    report.value("has_minimum", best.result.has_value());
    report.row("starts", "{} descents, seed {}", key("starts", options.starts), key("seed", options.seed));
    report.value("loss", options.loss);
    add_evaluation(report, evaluator->report(), seconds_since(start));
    report.value("integrand_evaluations", evaluator->report().evaluations);
    if (!best.result) return Fit{public_report(report, false), false, scene};

    const Scene fitted = scene.with(best.overrides());
    if (!options.output.empty()) {
      write_fitted(options.output, fitted);
      report.row("written", "{}", key("output", options.output.string()));
    }
    if (!options.plot.empty()) {
      const auto contours = fit::contours_of(*best.model, *evaluator, *best.result, fit_options);
      if (contours) add_contours(report, *best.model, *contours);
      report.value("brackets", brackets(fitted, sets, *evaluator));
      draw_fit(report.json_text(), options.plot.string());
      report.row("picture", "{}", key("plot", options.plot.string()));
    }
    Fit found{public_report(report, (best.result->status & kStatusToleranceMissed) == 0, options.output), true, fitted};
    add_numbers(found, *best.result);
    return found;
  });
}

}  // namespace dolp::api
