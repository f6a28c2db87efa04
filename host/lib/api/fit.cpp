// Numbers of a scene from measured data.
#include "fit/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <limits>

#include <dolp/fit.hpp>
#include <dolp/status.hpp>
#include "api/evaluator_impl.hpp"
#include "api/reports.hpp"
#include "api/scene_impl.hpp"
#include "base/atomic_file.hpp"
#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "report/fit_picture.hpp"
#include "report/fit_report.hpp"
#include "report/run_report.hpp"
#include "run/scene_run.hpp"
#include "scene/points.hpp"
#include "scene/scene_reader.hpp"
#include "scene/scene_writer.hpp"

namespace dolp {
namespace {

using Settings = std::vector<Setting>;

void check_loss(Loss loss, const std::vector<MeasuredData>& data) {
  for (const MeasuredData& one : data) {
    if (loss == Loss::kSquares || one.has_uncertainties) continue;
    throw InputError(fmt::format("loss {}: {} needs the column \"uncertainty\", which says what lies off",
                                 loss_names()[static_cast<std::size_t>(loss)], one.name));
  }
}

/// All combinations of the compared settings, one list each; one empty list where nothing is compared.
std::vector<Settings> combinations(const FitOptions& options) {
  std::vector<Settings> all = {{}};
  for (const Comparison& comparison : options.compare) {
    if (std::ranges::find(options.vary, comparison.key, &FitRange::key) != options.vary.end()) {
      throw InputError(fmt::format("{}: varies and cannot be compared too", comparison.key));
    }
    std::vector<Settings> more;
    for (const Settings& one : all) {
      for (const std::string& word : comparison.words) {
        more.push_back(one);
        more.back().push_back({comparison.key, TomlText{word}, fmt::format("{} = {}", comparison.key, one_line(word))});
      }
    }
    all = std::move(more);
  }
  return all;
}

/// The best of the compared models.
struct Best {
  std::unique_ptr<fit::Model> model;
  std::optional<fit::FitResult> result;
  Settings compared;

  /// The compared settings, with the fitted values.
  Settings settings() const {
    const std::vector<FitParameter>& found = result.value().parameters;
    Eigen::VectorXd values(static_cast<Eigen::Index>(found.size()));
    for (Eigen::Index j = 0; j < values.size(); ++j) values[j] = found[static_cast<std::size_t>(j)].value;
    Settings all = compared;
    std::ranges::copy(model->settings(values), std::back_inserter(all));
    return all;
  }
};

void check_outputs(const FitOptions& options, const SceneValues& scene, const std::vector<MeasuredData>& data) {
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
ReportBuilder::Json brackets(const Scene& fitted, const std::vector<MeasuredData>& sets, MomentsEvaluator& evaluator) {
  ReportBuilder::Json all = ReportBuilder::Json::array();
  for (const MeasuredData& data : sets) {
    ReportBuilder::Json& one = all.emplace_back(nullptr);
    const bool has_dolp =
        std::ranges::any_of(data.measurements, [](const Measurement& o) { return o.observable == Observable::kDolp; });
    if (!has_dolp) continue;
    Settings settings = data.settings;
    settings.push_back({"emission.bracket", true});
    try {
      const SceneValues scene = with_settings(fitted.impl().scene, settings);
      std::vector<double> theta_deg;
      for (const Measurement& o : data.measurements) theta_deg.push_back(o.theta_deg);
      std::ranges::sort(theta_deg);
      const Column zeniths{"theta_deg", theta_deg};
      const Points points = points_of(std::span(&zeniths, 1), theta_deg.size(), PointsKind::kDirections);
      one["theta_deg"] = theta_deg;
      for (const PointResult& result : evaluate_scene(scene, point_entries(scene, points), evaluator, {})) {
        one["low"].push_back(result[Quantity::kDolpLow]);
        one["high"].push_back(result[Quantity::kDolpHigh]);
      }
    } catch (const InputError&) {
      continue;  // a scene without a bracket
    }
  }
  return all;
}

void add_numbers(Fit& found, const fit::FitResult& result) {
  found.parameters = result.parameters;
  found.chi_square = result.chi_square;
  found.degrees_of_freedom = result.degrees_of_freedom;
  found.p_value = result.p_value;
  found.other_minima = result.minima.size();
  found.degeneracies = result.degeneracies;
}

void write_fitted(const std::filesystem::path& path, const Scene& fitted) {
  write_text_atomically(path, fitted.toml(path.has_parent_path() ? path.parent_path() : "."));
}

}  // namespace

Fit Evaluator::fit(const Scene& scene, const std::vector<MeasuredData>& data, const FitOptions& options) {
  return impl_->exclusively([&] {
    const auto start = std::chrono::steady_clock::now();
    const SceneValues& own = scene.impl().scene;
    check_loss(options.loss, data);

    begin(options.progress, 1);
    std::vector<ComparedModel> models;
    MomentsEvaluator* evaluator = nullptr;
    Best best;
    const std::vector<Settings> compared = combinations(options);
    for (const Settings& settings : compared) {
      ComparedModel& one = models.emplace_back();
      one.settings = settings;
      std::unique_ptr<fit::Model> model;
      try {
        model = std::make_unique<fit::Model>(with_settings(own, settings), data, options.vary);
      } catch (const InputError& error) {
        if (compared.size() == 1) throw;
        one.refusal = error.what();
        continue;
      }
      if (evaluator == nullptr) {
        check_outputs(options, model->scene(), data);
        evaluator = impl_->begin(model->scene());
      }
      one.result = fit::fit(*model, *evaluator, options);
      if (one.result && (!best.result || one.result->aic < best.result->aic)) {
        best = {std::move(model), one.result, settings};
      }
    }
    if (evaluator == nullptr) throw InputError(models.front().refusal);
    std::ranges::stable_sort(models, {}, [](const ComparedModel& one) {
      return one.result ? one.result->aic : std::numeric_limits<double>::infinity();
    });

    ReportBuilder report;
    report.line("{}", key("title", own.title));
    if (best.result) {
      report.row("data", "{} measured values of {} file{}", key("observations", best.model->observation_count()),
                 data.size(), data.size() == 1 ? "" : "s");
      if (models.size() > 1) add_comparison(report, models);
      add_fit(report, *best.model, *best.result);
    } else {
      report.row("minimum", "none was found: no descent converged; try other ranges, or more starts");
    }
    report.value("has_minimum", best.result.has_value());
    report.row("starts", "{} descents, seed {}", key("starts", options.starts), key("seed", options.seed));
    report.value("loss", loss_names()[static_cast<std::size_t>(options.loss)]);
    add_evaluation(report, evaluator->report(), seconds_since(start));
    report.value("integrand_evaluations", evaluator->report().evaluations);
    if (!best.result) return Fit{public_report(report, false), false, scene};

    const Scene fitted = scene.with(best.settings());
    if (!options.output.empty()) {
      write_fitted(options.output, fitted);
      report.row("written", "{}", key("output", options.output.string()));
    }
    if (!options.plot.empty()) {
      const auto contours = fit::contours_of(*best.model, *evaluator, *best.result, options);
      if (contours) add_contours(report, *best.model, *contours);
      report.value("brackets", brackets(fitted, data, *evaluator));
      draw_fit(report.json_text(), options.plot.string());
      report.row("picture", "{}", key("plot", options.plot.string()));
    }
    Fit found{public_report(report, (best.result->status & kToleranceNotMet) == 0, options.output), true, fitted};
    add_numbers(found, *best.result);
    return found;
  });
}

}  // namespace dolp
