#include "explore/fitting.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "fit/fit.hpp"

namespace dolp::explore {
namespace {

constexpr std::size_t kStarts = 24;

/// DOLP, or Q/I where some of it is negative.
fit::FitData data_of(const MeasuredPoints& points, const Scene& scene) {
  fit::FitData data;
  data.name = points.name;
  data.zenith_column = scene.geometry.mode == Mode::kBistatic ? "theta_i_deg" : "theta_deg";
  data.has_uncertainties = !points.uncertainty.empty();
  const bool is_signed = std::ranges::any_of(points.dolp, [](double dolp) { return dolp < 0.0; });
  for (std::size_t i = 0; i < points.dolp.size(); ++i) {
    fit::Observation& one = data.observations.emplace_back();
    one.observable = is_signed ? fit::Observable::kQOverI : fit::Observable::kDolp;
    one.theta_deg = points.theta_deg[i];
    one.value = points.dolp[i];
    if (data.has_uncertainties) one.uncertainty = points.uncertainty[i];
  }
  return data;
}

FitInterval interval_of(const fit::Interval& interval) { return {interval.low, interval.high}; }

}  // namespace

FitFound run_fit(const FitJob& job, MomentsEvaluator& evaluator, const Progress& progress) {
  std::vector<fit::Parameter> parameters;
  for (const Varied& one : job.varied) parameters.push_back({one.key, one.low, one.high, one.start});
  const fit::Model model({job.scene.text, job.scene.path_name, job.scene.overrides}, {data_of(job.points, job.scene)},
                         parameters);
  const auto result = fit::fit(model, evaluator, {.starts = kStarts, .progress = progress});
  if (!result) throw InputError("no minimum was found: no descent converged");
  FitFound found;
  for (const fit::FittedParameter& one : result->parameters) {
    found.values.emplace_back(one.key, fmt::format("{:.6g}", one.value));
    found.interval_68[one.key] = interval_of(one.interval_68);
    found.interval_95[one.key] = interval_of(one.interval_95);
  }
  found.text = fmt::format("χ² {:.4g}, {} degrees of freedom", result->chi_square, result->degrees_of_freedom);
  if (result->p_value) found.text += fmt::format(", p {:.2g}", *result->p_value);
  if (!result->minima.empty()) found.text += fmt::format("; {} other minima", result->minima.size());
  for (const std::string& words : result->degeneracies) found.text += "; " + words;
  return found;
}

bool Fitting::can_vary(const Parameter& parameter) { return !parameter.description->key.starts_with("accuracy."); }

void Fitting::mark(const std::string& key, bool varies) {
  if (varies) {
    marked_.insert(key);
  } else {
    marked_.erase(key);
  }
}

std::optional<FitJob> Fitting::job(const Scene& scene, const std::optional<MeasuredPoints>& points) const {
  if (!points) return std::nullopt;
  FitJob job{scene, *points, {}};
  for (const Parameter& parameter : parameters()) {
    const std::string& key = parameter.description->key;
    const std::optional<double> value = parameter.value(scene);
    if (!value || !varies(key)) continue;
    job.varied.push_back({key, std::min(parameter.slider.min, *value), std::max(parameter.slider.max, *value), *value});
  }
  return job.varied.empty() ? std::nullopt : std::optional(std::move(job));
}

void Fitting::take(FitFound found, std::vector<std::string> overrides) {
  found_ = std::move(found);
  overrides_ = std::move(overrides);
}

const FitFound* Fitting::found(const std::vector<std::string>& overrides) const {
  return found_ && overrides_ == overrides ? &*found_ : nullptr;
}

}  // namespace dolp::explore
