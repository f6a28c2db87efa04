#include "fit/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include <dolp/fit.hpp>
#include <dolp/status.hpp>
#include "api/impl.hpp"
#include "base/atomic_file.hpp"
#include "base/python_picture.hpp"
#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "fit/residuals.hpp"
#include "report/fit_report.hpp"
#include "report/run_report.hpp"
#include "run/scene_run.hpp"
#include "scene/embedded_data.hpp"
#include "scene/scene_keys.hpp"
#include "scene/scene_reader.hpp"

namespace dolp {
namespace {

using Settings = std::vector<Setting>;
using Json = ReportBuilder::Json;

void check_loss(Loss loss, ModelError error, const std::vector<MeasuredData>& data) {
  if (loss != Loss::kSquares && error != ModelError::kNone) {
    throw InputError(
        fmt::format("loss {}: cannot be combined with a model error, whose intervals need the loss squares",
                    loss_names()[static_cast<std::size_t>(loss)]));
  }
  for (const MeasuredData& data_set : data) {
    if (loss == Loss::kSquares || data_set.has_uncertainties) continue;
    throw InputError(fmt::format("loss {}: {} needs the column \"uncertainty\", against which residuals are weighed",
                                 loss_names()[static_cast<std::size_t>(loss)], data_set.name));
  }
}

void check_comparison(const Comparison& comparison, const FitOptions& options) {
  const std::string& name = comparison.key;
  if (std::ranges::find(options.vary, name, &FitRange::key) != options.vary.end())
    throw InputError(name + ": varies and cannot be compared too");
  if (std::ranges::count(options.compare, name, &Comparison::key) > 1)
    throw InputError(name + ": is compared twice; give all of its values at once");
  if (comparison.words.empty()) throw InputError(name + ": is compared without a value");
  const SceneKey* const known = find_scene_key(name);
  for (const std::string& word : comparison.words) {
    if (std::ranges::count(comparison.words, word) > 1)
      throw InputError(fmt::format("{} = {}: is compared twice", name, one_line(word)));
    const bool is_plain = known != nullptr && known->description.type == Key::Type::kWord && !word.starts_with('"');
    if (!is_plain || std::ranges::count(known->description.words, word) > 0) continue;
    throw InputError(fmt::format("{} = {}: must be {}", name, one_line(word), known->description.allowed()));
  }
}

/// Every combination of the words to compare, as a list of settings. If nothing is compared, returns one empty list.
std::vector<Settings> combinations(const FitOptions& options) {
  std::vector<Settings> all = {{}};
  for (const Comparison& comparison : options.compare) {
    check_comparison(comparison, options);
    std::vector<Settings> more;
    for (const Settings& settings : all) {
      for (const std::string& word : comparison.words) {
        more.push_back(settings);
        more.back().push_back({comparison.key, TomlText{word}, fmt::format("{} = {}", comparison.key, one_line(word))});
      }
    }
    all = std::move(more);
  }
  return all;
}

void check_plot(const std::filesystem::path& path) {
  const std::string suffix = lower_case(path.extension().string());
  if (path.empty() || suffix == ".png" || suffix == ".pdf" || suffix == ".svg") return;
  throw InputError(fmt::format("plot {}: must end in .png, .pdf or .svg", one_line(path.string())));
}

void check_starts(std::size_t starts) {
  if (starts >= 1 && starts <= kMostStarts) return;
  throw InputError(fmt::format("starts = {}: must be a whole number from 1 to {}", starts, kMostStarts));
}

void check_outputs(const FitOptions& options, const SceneValues& scene, const std::vector<MeasuredData>& data) {
  std::vector<std::string> inputs = scene_files(scene);
  for (const MeasuredData& data_set : data) inputs.push_back(data_set.name);
  for (const std::filesystem::path& path : {options.output, options.plot}) {
    if (path.empty()) continue;
    check_output_is_no_input(path, inputs);
    check_writable(path);
  }
}

std::vector<double> fine_zeniths(const MeasuredData& data) {
  constexpr int kSteps = 120;
  const auto [least, largest] = std::ranges::minmax(data.measurements, {}, &Measurement::theta_deg);
  std::vector<double> zeniths;
  for (int i = 0; i <= kSteps; ++i) {
    zeniths.push_back(std::lerp(least.theta_deg, largest.theta_deg, static_cast<double>(i) / kSteps));
  }
  return zeniths;
}

/// The coordinates of the best minimum.
const Eigen::VectorXd& best_point(const ComparedModel& fitted) { return fitted.result->valley_points.front().where.at; }

Settings fitted_settings(const ComparedModel& fitted) {
  Settings all = fitted.settings;
  std::ranges::copy(fitted.model->settings(fitted.model->values(best_point(fitted))), std::back_inserter(all));
  return all;
}

/// The predictions of the fitted model for `data`. Empty if Model refuses the scene, for example without a bracket.
std::optional<fit::Prediction> predicted(const ComparedModel& best, MeasuredData data, const FitOptions& options,
                                         ModelError error, ModelEvaluator& evaluator) {
  data.has_uncertainties = true;  // Model wants them with a bracket; the prediction does not depend on them
  // Model needs at least as many measurements as parameters. So copies of the first are added; their values are unused.
  data.measurements.resize(std::max(data.measurements.size(), options.vary.size()), data.measurements.front());
  try {
    const fit::Model model(best.scene, {data}, options.vary, error);
    return model.predict({model.values(best_point(best))}, best.result->tolerance, evaluator, {}).front();
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// Copies of `measurement` at each of the zeniths, with the settings of `data`.
MeasuredData at_zeniths(MeasuredData data, const Measurement& measurement, const std::vector<double>& zeniths) {
  data.measurements.assign(zeniths.size(), measurement);
  for (std::size_t i = 0; i < zeniths.size(); ++i) data.measurements[i].theta_deg = zeniths[i];
  return data;
}

/// Adds the fitted model over the zenith for each data set, quantity and wavelength, and the bracket of each data set.
void add_curves(ReportBuilder& report, const ComparedModel& best, const FitOptions& options,
                ModelEvaluator& evaluator) {
  Json curves = Json::array(), brackets = Json::array();
  for (const MeasuredData& data : best.model->data()) {
    const std::vector<double> zeniths = fine_zeniths(data);
    std::map<std::pair<Observable, std::optional<double>>, Measurement> kinds;
    for (const Measurement& measurement : data.measurements)
      kinds.emplace(std::pair(measurement.observable, measurement.wavelength_um), measurement);
    for (const auto& [kind, measurement] : kinds) {
      const MeasuredData fine = at_zeniths(data, measurement, zeniths);
      const auto found = predicted(best, fine, options, ModelError::kNone, evaluator);
      if (!found) continue;
      curves.push_back({{"data", data.name},
                        {"quantity", to_name(kind.first)},
                        {"wavelength_um", kind.second ? Json(*kind.second) : Json(nullptr)},
                        {"theta_deg", zeniths},
                        {"model", std::vector<double>(found->values.begin(), found->values.end())}});
    }
    Json& bracket = brackets.emplace_back(nullptr);
    const Measurement& first = data.measurements.front();
    const bool is_drawn = first.observable == Observable::kDolp || first.observable == Observable::kQOverI;
    if (!is_drawn || first.wavelength_um) continue;
    const MeasuredData fine = at_zeniths(data, first, zeniths);
    const auto found = predicted(best, fine, options, ModelError::kBracket, evaluator);
    if (!found) continue;
    const auto low = found->bracket.col(1), high = found->bracket.col(2);
    bracket = {{"low", std::vector<double>(low.begin(), low.end())},
               {"high", std::vector<double>(high.begin(), high.end())},
               {"theta_deg", zeniths}};
  }
  report.value("brackets", brackets);
  report.value("curves", curves);
}

/// The largest distance between the fitted value of a point and the farther end of its bracket. Empty without bracket.
struct ModelGap {
  std::optional<double> distance;
  std::optional<double> in_uncertainties;  ///< largest ratio of the distance to the uncertainty of the point
  bool is_ignored = false;  ///< the fit's intervals ignore the bracket, which is wider than the uncertainties
};

ModelGap model_gap(const ComparedModel& best, const FitOptions& options, ModelEvaluator& evaluator) {
  ModelGap gap;
  for (const MeasuredData& data : best.model->data()) {
    const auto found = predicted(best, data, options, ModelError::kBracket, evaluator);
    for (std::size_t i = 0; found && i < data.measurements.size(); ++i) {
      const auto at = found->bracket.row(static_cast<Eigen::Index>(i));
      const double distance = std::max(at[2] - at[0], at[0] - at[1]);
      if (!(distance >= 0.0)) continue;
      gap.distance = std::max(gap.distance.value_or(0.0), distance);
      if (!data.has_uncertainties) continue;
      gap.in_uncertainties = std::max(gap.in_uncertainties.value_or(0.0), distance / *data.measurements[i].uncertainty);
    }
  }
  gap.is_ignored = gap.in_uncertainties > 1.0 && options.model_error == ModelError::kNone;
  return gap;
}

void add_model_gap(ReportBuilder& report, const ModelGap& gap) {
  report.row_if(gap.distance.has_value(), "bracket",
                "of all bounces: its far end lies up to {:.2g} points{} from the fit{}",
                kPoints * gap.distance.value_or(0.0),
                gap.in_uncertainties ? fmt::format(" ({:.2g} uncertainties)", *gap.in_uncertainties) : "",
                gap.is_ignored ? ": the fit is at most doubtful" : "");
  report.value("model_gap", gap.distance);
  report.value("model_gap_in_uncertainties", gap.in_uncertainties);
}

/// Fits the scene with each combination of compared settings. Returns the models, the best first. Calls `begin` at most
/// once, to get the evaluator. Errors: InputError if with_settings() or Model refuses all combinations.
std::vector<ComparedModel> fit_models(const SceneValues& scene, const std::vector<MeasuredData>& data,
                                      const FitOptions& options,
                                      const std::function<ModelEvaluator*(const SceneValues&)>& begin) {
  constexpr double kNoAic = std::numeric_limits<double>::infinity();
  ModelEvaluator* evaluator = nullptr;
  double least_aic = kNoAic;
  std::vector<ComparedModel> models;
  const std::vector<Settings> compared = combinations(options);
  for (const Settings& settings : compared) {
    ComparedModel& own = models.emplace_back();
    own.settings = settings;
    try {
      own.scene = with_settings(scene, settings);
      own.model = std::make_unique<fit::Model>(own.scene, data, options.vary, options.model_error);
    } catch (const InputError& error) {
      if (compared.size() == 1) throw;
      own.refusal = error.what();
      continue;
    }
    if (evaluator == nullptr) evaluator = begin(own.model->scene());
    own.result = fit::fit(*own.model, *evaluator, options, least_aic);
    if (own.result) least_aic = std::min(least_aic, own.result->aic);
  }
  if (evaluator == nullptr) throw InputError(models.front().refusal);
  std::ranges::stable_sort(models, {}, [](const ComparedModel& own) { return own.result ? own.result->aic : kNoAic; });
  return models;
}

void draw(ReportBuilder& report, const ComparedModel& best, const Scene& fitted, const FitOptions& options,
          ModelEvaluator& evaluator) {
  add_contours(report, best, fit::compute_contours(*best.model, evaluator, *best.result, options));
  const Spectrum& spectrum = fitted.impl().scene.spectrum;
  report.value("spectrum_um", Json{spectrum.min_um, spectrum.max_um});
  add_curves(report, best, options, evaluator);
  draw_with_python(embedded_plot_fit_py().data(), report.json_text(), options.plot.string());
  report.row("picture", "{}", key("plot", options.plot.string()));
}

}  // namespace

Fit Evaluator::fit(const Scene& scene, const std::vector<MeasuredData>& data, const FitOptions& call_options) {
  return impl().exclusively(scene, call_options, [&](const SceneValues& values, const FitOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    check_loss(options.loss, options.model_error, data);
    check_starts(options.starts);
    check_plot(options.plot);
    check_labels_chosen(values);
    report_start(options.progress, 1);
    ModelEvaluator* evaluator = nullptr;
    std::vector<ComparedModel> models = fit_models(values, data, options, [&](const SceneValues& first) {
      check_outputs(options, first, data);
      return evaluator = impl_->begin(first);
    });
    ComparedModel& best = models.front();

    ReportBuilder report;
    ModelGap gap;
    add_title(report, values);
    if (best.result) {
      report.row("data", "{} measured values of {} file{}", key("observations", best.model->observation_count()),
                 data.size(), data.size() == 1 ? "" : "s");
      if (models.size() > 1) add_comparison(report, models);
      gap = model_gap(best, options, *evaluator);
      if (gap.is_ignored && best.result->fit_quality == "good") best.result->fit_quality = "doubtful";
      add_fit(report, best);
    } else {
      report.row("minimum", "none was found: no descent converged; try other ranges, or more starts");
    }
    report.value("has_minimum", best.result.has_value());
    report.row("starts", "{} descents, seed {}", key("starts", options.starts), key("seed", options.seed));
    report.value("loss", loss_names()[static_cast<std::size_t>(options.loss)]);
    const Scene fitted = best.result ? scene.with(fitted_settings(best)) : scene;
    if (best.result) add_model_gap(report, gap);
    if (best.result && !options.output.empty()) {
      const std::filesystem::path folder = options.output.has_parent_path() ? options.output.parent_path() : ".";
      write_text_atomically(options.output, fitted.toml(folder));
    }
    if (best.result && !options.plot.empty()) draw(report, best, fitted, options, *evaluator);
    add_evaluation(report, evaluator->report(), seconds_since(start));
    report.value("integrand_evaluations", evaluator->report().evaluations);
    if (!best.result) return Fit{{}, public_report(report, false), false, scene};
    if (!options.output.empty()) report.row("written", "{}", key("output", options.output.string()));
    const bool is_good = (best.result->status & kAnyToleranceNotMet) == 0;
    Fit found{*best.result, public_report(report, is_good, options.output), true, fitted};
    for (const FitRange& range : options.vary) {
      for (const std::string& rival : keys_replaced_by(range.key)) {
        if (best.scene.document->find(rival))
          found.report.remarks.push_back(fmt::format("fit: {} takes the place of the scene's {}", range.key, rival));
      }
    }
    if (gap.is_ignored) {
      found.report.remarks.push_back(
          fmt::format("fit: light of further bounces can move the model by {:.2g} uncertainties of a point, which the "
                      "intervals ignore; --model-error bracket includes it",
                      *gap.in_uncertainties));
    }
    return found;
  });
}

}  // namespace dolp
