#include "report/fit_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <dolp/status.hpp>
#include "base/text.hpp"
#include "report/run_report.hpp"

namespace dolp {
namespace {

using fit::FitResult;

using Json = ReportBuilder::Json;

constexpr double kStrongCorrelation = 0.9;
constexpr double kTooGood = 0.999;  // above this p-value, the uncertainties look too large
// Limits for the difference of Akaike's criterion between a model and the best model. Up to kAlike the data cannot tell
// the two apart. Up to kPossible the model may be true.
constexpr double kAlike = 1.3;
constexpr double kPossible = 4.0;

Json value_json(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json value_json(const Eigen::VectorXd& values) { return std::vector<double>(values.begin(), values.end()); }

Json value_json(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    rows.push_back(value_json(Eigen::VectorXd(matrix.row(i).transpose())));
  return rows;
}

Json value_json(const FitInterval& interval) {
  return interval.is_empty ? Json(nullptr) : Json::array({value_json(interval.low), value_json(interval.high)});
}

std::string to_text(const std::optional<double>& value, const char* none) {
  return value ? fmt::format("{:.6g}", *value) : none;
}

std::string to_text(const FitInterval& interval) {
  return interval.is_empty ? "none"
                           : fmt::format("{} .. {}", to_text(interval.low, "open"), to_text(interval.high, "open"));
}

struct NamedInterval {
  std::string key, name;
  const FitInterval& interval;
};
std::vector<NamedInterval> named_intervals(const FitParameter& parameter) {
  return {{"68", "68 %", parameter.interval_68}, {"95", "95 %", parameter.interval_95}};
}

Json parameter_json(const FitParameter& parameter) {
  Json json = {
      {"key", parameter.key}, {"value", parameter.value}, {"standard_error", value_json(parameter.standard_error)}};
  for (const auto& [key, name, interval] : named_intervals(parameter)) json["interval_" + key] = value_json(interval);
  json["at_bound"] = parameter.is_at_bound;
  if (!parameter.standard_error) json["why_no_error"] = parameter.why_no_error;
  for (const auto& [key, name, interval] : named_intervals(parameter)) {
    if (interval.pieces.size() < 2) continue;
    for (const auto& [low, high] : interval.pieces) json["pieces_" + key].push_back(value_json(FitInterval{low, high}));
  }
  if (parameter.scaled_68)
    json.update({{"scaled_68", value_json(*parameter.scaled_68)}, {"scaled_95", value_json(*parameter.scaled_95)}});
  return json;
}

void add_remarks(ReportBuilder& report, const FitParameter& parameter, const FitResult& result) {
  report.row_if(!parameter.standard_error, "no error", "{}: {}", parameter.key, parameter.why_no_error);
  for (const auto& [key, name, interval] : named_intervals(parameter)) {
    std::vector<std::string> pieces;
    for (const auto& [low, high] : interval.pieces) pieces.push_back(to_text(FitInterval{low, high}));
    report.row_if(pieces.size() > 1, "pieces", "{}: the {} interval has gaps: {}", parameter.key, name,
                  fmt::format("{}", fmt::join(pieces, " and ")));
  }
  if (!parameter.scaled_68) return;
  report.row("scaled", "{}: uncertainties {:.3g} times as large give 68 % {}, 95 % {}", parameter.key,
             std::sqrt(result.reduced_chi_square.value()), to_text(*parameter.scaled_68),
             to_text(*parameter.scaled_95));
}

void add_parameters(ReportBuilder& report, const FitResult& result) {
  Json list = Json::array();
  std::size_t width = 9;
  std::vector<std::string> held;
  for (const FitParameter& parameter : result.parameters) {
    list.push_back(parameter_json(parameter));
    width = std::max(width, parameter.key.size());
    if (parameter.is_at_bound) held.push_back(parameter.key);
  }
  report.value("parameters", list);
  report.line("  {:<{}}  {:>11}  {:>11}  {:^25}  {:^25}", "parameter", width, "value", "std. error", "68 %", "95 %");
  for (const FitParameter& fitted : result.parameters) {
    report.line("  {:<{}}  {:>11.6g}  {:>11}  {:^25}  {:^25}{}", fitted.key, width, fitted.value,
                fitted.standard_error ? fmt::format("{:.2g}", *fitted.standard_error) : "none",
                to_text(fitted.interval_68), to_text(fitted.interval_95), fitted.is_at_bound ? "  at its bound" : "");
  }
  for (const FitParameter& parameter : result.parameters) add_remarks(report, parameter, result);
  const bool has_errors = std::ranges::any_of(
      result.parameters, [](const FitParameter& parameter) { return parameter.standard_error.has_value(); });
  report.row_if(has_errors && !held.empty(), "errors", "hold with {} kept at the bound; the intervals do not assume it",
                join(held));
  report.value("errors_with_kept", held);
}

void add_correlations(ReportBuilder& report, const FitResult& result) {
  report.value("correlation", value_json(result.correlation));
  for (Eigen::Index i = 0; i < result.correlation.rows(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      const double correlation = result.correlation(i, j);
      if (!std::isfinite(correlation)) continue;
      report.row("correlated", "{} and {}: {:+.3f}{}", result.parameters[static_cast<std::size_t>(j)].key,
                 result.parameters[static_cast<std::size_t>(i)].key, correlation,
                 std::abs(correlation) > kStrongCorrelation ? ", strongly" : "");
    }
  }
}

void add_misfit(ReportBuilder& report, const fit::Model& model, const FitResult& result) {
  const std::string quality = fit::fit_quality(result.p_value);  // result.fit_quality also judges the model
  report.row("minimum", "chi_square {:.6g}, {} degrees of freedom{}{}", key("chi_square", result.chi_square),
             key("degrees_of_freedom", result.degrees_of_freedom),
             result.reduced_chi_square ? fmt::format(", reduced {:.4g}", *result.reduced_chi_square) : "",
             result.p_value ? fmt::format(", p-value {:.3g}: {}", *result.p_value, result.fit_quality) : "");
  report.value("fit_quality", quality.empty() ? Json(nullptr) : Json(result.fit_quality));
  report.value("reduced_chi_square", result.reduced_chi_square);
  report.value("p_value", result.p_value);
  report.value("aic", result.aic);
  report.value("bic", result.bic);
  report.value("scale_from", model.has_uncertainties() ? "uncertainties" : "residuals");
  report.row_if(!model.has_uncertainties() && result.degrees_of_freedom > 0, "scale",
                "the data have no uncertainties: the residuals give one of {:.3g}, for intervals and errors",
                key("residual_standard_deviation", std::sqrt(result.scale)));
  report.row_if(quality == "doubtful", "misfit",
                "the residuals exceed the uncertainties: model or uncertainties are probably wrong");
  report.row_if(quality == "bad", "misfit",
                "the model does not fit: the residuals exceed the uncertainties, and the intervals mean little");
  report.row_if(result.p_value > kTooGood && !model.has_model_error(), "misfit",
                "the residuals are far below the uncertainties, which look too large");
  report.row_if(!model.has_uncertainties() && result.degrees_of_freedom == 0, "scale",
                "as many parameters as points: no interval can be given");
}

/// If the fit assumes a model error (the bracket), adds how much of each parameter's range its 95 % interval covers.
void add_model_error(ReportBuilder& report, const fit::Model& model, const FitResult& result) {
  if (!model.has_model_error()) return;
  const auto is_empty_95 = [](const auto& parameter) { return parameter.interval_95.is_empty; };
  if (std::ranges::any_of(result.parameters, is_empty_95)) {
    report.row("bracket", "the data exclude every value, with the light that single scattering loses too");
    return;
  }
  std::vector<std::string> left, hardly;
  for (std::size_t j = 0; j < result.parameters.size(); ++j) {
    const FitRange& range = model.parameters()[j];
    const FitInterval& interval = result.parameters[j].interval_95;
    const double width = interval.high.value_or(range.high) - interval.low.value_or(range.low);
    left.push_back(fmt::format("{:.0f} % of the range of {}", kPercent * width / (range.high - range.low), range.key));
    if (width > 0.5 * (range.high - range.low)) hardly.push_back(range.key);
  }
  report.row("bracket",
             "at 95 % single scattering leaves {}{}; surface.masking \"v-cavity\" with surface.scattering "
             "\"multiple\" follows all bounces and determines more",
             fmt::format("{}", fmt::join(left, ", ")),
             hardly.empty() ? "" : fmt::format(": it hardly determines {}", fmt::join(hardly, " and ")));
}

void add_minima(ReportBuilder& report, const FitResult& result) {
  Json list = Json::array();
  for (const FitMinimum& minimum : std::span(result.minima).subspan(1)) {
    list.push_back({{"values", minimum.values}, {"chi_square", minimum.chi_square}});
    std::string text;
    for (std::size_t j = 0; j < minimum.values.size(); ++j)
      text += fmt::format(", {} {:.6g}", result.parameters[j].key, minimum.values[j]);
    report.row("also", "a local minimum with chi_square {:.6g}{}", minimum.chi_square, text);
  }
  report.value("minima", list);
}

void add_points(ReportBuilder& report, const fit::Model& model, const FitResult& result) {
  report.value("residuals", value_json(result.residuals));
  report.value("jacobian", value_json(result.jacobian));
  Json points = Json::array();
  Eigen::Index row = 0;
  for (const MeasuredData& data : model.data()) {
    for (const Measurement& measurement : data.measurements) {
      points.push_back({{"data", data.name},
                        {"quantity", to_name(measurement.observable)},
                        {"theta_deg", measurement.theta_deg},
                        {"wavelength_um", value_json(measurement.wavelength_um)},
                        {"measured", measurement.value},
                        {"uncertainty", value_json(measurement.uncertainty)},
                        {"model", result.predicted[row]},
                        {"residual", result.residuals[row]}});
      ++row;
    }
  }
  report.value("points", points);
}

std::vector<std::string> setting_texts(const ComparedModel& model) {
  std::vector<std::string> texts;
  for (const Setting& setting : model.settings) texts.push_back(setting.text());
  return texts;
}

std::string model_text(const ComparedModel& model) { return fmt::format("{}", fmt::join(setting_texts(model), " ")); }

std::string why_no_contours(const FitResult& result, const std::optional<fit::Contours>& drawn) {
  if (result.parameters.size() < 2) return "";
  if (drawn && !(drawn->growth.array() > fit::kContourLevels.front()).any()) {
    return fmt::format(
        "none: within the ranges chi_square grows by less than {:.2f}, or its valley is longer than {} parameter sets "
        "reach",
        fit::kContourLevels.front(), result.evaluations);
  }
  if (drawn) return "";
  std::vector<std::string> reasons;
  for (const FitParameter& parameter : result.parameters) {
    if (!parameter.standard_error) reasons.push_back(parameter.key + ": " + parameter.why_no_error);
  }
  return fmt::format("none: they need two parameters that the data determine within their ranges ({})",
                     fmt::join(reasons, "; "));
}

/// The smallest interval that contains the interval of each model. An end is open if it is open for any model.
FitInterval hull(const std::vector<const FitResult*>& results, std::size_t j, FitInterval FitParameter::*interval) {
  std::optional<FitInterval> hull;
  for (const FitResult* const result : results) {
    const FitInterval& other = result->parameters[j].*interval;
    if (other.is_empty) continue;
    if (!hull) hull = other;
    hull->low = hull->low && other.low ? std::optional(std::min(*hull->low, *other.low)) : std::nullopt;
    hull->high = hull->high && other.high ? std::optional(std::max(*hull->high, *other.high)) : std::nullopt;
  }
  return hull.value_or(FitInterval{.is_empty = true});
}

/// Adds the models within kAlike of the best AIC: the data cannot tell them apart. For each parameter, adds the
/// smallest interval that contains the intervals of all models within kPossible of the best AIC.
void add_alike(ReportBuilder& report, const std::vector<ComparedModel>& models, double least_aic) {
  std::vector<const FitResult*> possible;
  Json alike = Json::array(), ranges = Json::array();
  for (const ComparedModel& model : models) {
    if (!model.result || model.result->aic > least_aic + kPossible) continue;
    possible.push_back(&*model.result);
    if (model.result->aic <= least_aic + kAlike) alike.push_back(setting_texts(model));
  }
  if (alike.size() < 2) alike.clear();
  report.row_if(!alike.empty(), "alike", "the data cannot tell the first {} models apart: delta AIC is at most {}",
                alike.size(), kAlike);
  for (std::size_t j = 0; !possible.empty() && j < possible.front()->parameters.size(); ++j) {
    const std::string& name = possible.front()->parameters[j].key;
    const FitInterval at_68 = hull(possible, j, &FitParameter::interval_68);
    const FitInterval at_95 = hull(possible, j, &FitParameter::interval_95);
    report.row_if(possible.size() > 1, "range", "{}: over the {} models of delta AIC up to {}, 68 % {}, 95 % {}", name,
                  possible.size(), kPossible, to_text(at_68), to_text(at_95));
    ranges.push_back({{"key", name},
                      {"models", possible.size()},
                      {"interval_68", value_json(at_68)},
                      {"interval_95", value_json(at_95)}});
  }
  report.value("alike", alike);
  report.value("ranges", ranges);
}

}  // namespace

void add_fit(ReportBuilder& report, const ComparedModel& fitted) {
  const fit::Model& model = *fitted.model;
  const FitResult& result = fitted.result.value();
  add_misfit(report, model, result);
  add_parameters(report, result);
  add_model_error(report, model, result);
  add_correlations(report, result);
  for (const std::string& words : result.degeneracies) report.row("degenerate", "{}", words);
  report.value("degeneracies", result.degeneracies);
  add_minima(report, result);
  report.row("error", "numerical, of the model at most {:.2g} of an uncertainty; its tolerance {:g}",
             key("numerical_error", result.numerical_error), key("tolerance", result.tolerance));
  const std::uint32_t beyond = result.status & kNoDolpPromised;
  report.row_if(beyond != 0, "status", "{} at some point of the best fit: the model fails there",
                key("status", result.status));
  report.row_if((result.status & kToleranceNotMet) != 0, "status", "2 at some point: the tolerance is not met");
  report.row_if((result.status & kModelInaccurate) != 0 && !model.has_model_error(), "status", "32 at some point: {}",
                kModelInaccurateText);
  report.value("evaluations", result.evaluations);
  add_points(report, model, result);
}

void add_contours(ReportBuilder& report, const ComparedModel& fitted, const std::optional<fit::Contours>& drawn) {
  const std::string reason = why_no_contours(fitted.result.value(), drawn);
  report.row_if(!reason.empty(), "contours", "{}", reason);
  if (!reason.empty()) report.value("no_contours", reason);
  if (!reason.empty() || !drawn) return;
  const std::vector<FitRange>& parameters = fitted.model->parameters();
  report.value("contours", Json{{"keys", {parameters[drawn->parameters[0]].key, parameters[drawn->parameters[1]].key}},
                                {"levels", fit::kContourLevels},
                                {"x", value_json(drawn->values[0])},
                                {"y", value_json(drawn->values[1])},
                                {"growth", value_json(drawn->growth)},
                                {"evaluations", drawn->evaluations}});
}

void add_comparison(ReportBuilder& report, const std::vector<ComparedModel>& models) {
  Json list = Json::array();
  double least_aic = std::numeric_limits<double>::infinity();
  double least_bic = least_aic;
  std::size_t width = 5;
  for (const ComparedModel& model : models) {
    width = std::max(width, model_text(model).size());
    if (!model.result) continue;
    least_aic = std::min(least_aic, model.result->aic);
    least_bic = std::min(least_bic, model.result->bic);
  }
  report.line("  {:<{}}  {:>10}  {:>9}  {:>9}", "model", width, "chi_square", "delta AIC", "delta BIC");
  for (const ComparedModel& model : models) {
    Json json = {{"overrides", setting_texts(model)}};
    if (model.result) {
      const FitResult& result = *model.result;
      report.line("  {:<{}}  {:>10.5g}  {:>9.2f}  {:>9.2f}", model_text(model), width, result.chi_square,
                  result.aic - least_aic, result.bic - least_bic);
      json.update({{"chi_square", result.chi_square}, {"aic", result.aic}, {"bic", result.bic}});
      json["delta_aic"] = result.aic - least_aic;
      for (const FitParameter& parameter : result.parameters) {
        json["parameters"].push_back(parameter_json(parameter));
      }
    } else {
      const std::string reason = model.refusal.empty() ? "no minimum was found" : model.refusal;
      report.line("  {:<{}}  {}", model_text(model), width, reason);
      json["reason"] = reason;
    }
    list.push_back(json);
  }
  report.value("models", list);
  add_alike(report, models, least_aic);
}

}  // namespace dolp
