#include "explore/fitting.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.hpp"

namespace dolp::explore {

FitFound run_fit(const FitJob& job, Evaluator& evaluator, const Progress& progress) {
  FitOptions options{.vary = {}, .progress = progress};
  for (const Varied& one : job.varied) {
    options.vary.push_back({one.key, one.low, one.high, one.start});
  }
  const Fit fit = evaluator.fit(job.scene, {job.data}, options);
  if (!fit.has_minimum) throw InputError("no minimum was found: no descent converged");
  FitFound found;
  for (const FitParameter& one : fit.parameters) {
    found.values.push_back({one.key, TomlText{fmt::format("{:.6g}", one.value)}});
    found.interval_68[one.key] = one.interval_68;
    found.interval_95[one.key] = one.interval_95;
  }
  found.text = fmt::format("χ² {:.4g}, {} degrees of freedom", fit.chi_square, fit.degrees_of_freedom);
  if (fit.p_value) found.text += fmt::format(", p {:.2g}", *fit.p_value);
  if (fit.other_minima > 0) found.text += fmt::format("; {} other minima", fit.other_minima);
  for (const std::string& words : fit.degeneracies) found.text += "; " + words;
  return found;
}

bool Fitting::can_vary(const Parameter& parameter) { return !parameter.key->key.starts_with("accuracy."); }

void Fitting::mark(const std::string& key, bool varies) {
  if (varies) {
    marked_.insert(key);
  } else {
    marked_.erase(key);
  }
}

std::optional<FitJob> Fitting::job(const Scene& scene, const std::optional<MeasuredPoints>& points) const {
  if (!points) return std::nullopt;
  FitJob job{scene, points->data, {}};
  for (const Parameter& parameter : parameters()) {
    const std::string& key = parameter.key->key;
    const std::optional<double> value = parameter.value(scene);
    if (!value || !varies(key)) continue;
    job.varied.push_back({key, std::min(parameter.slider.min, *value), std::max(parameter.slider.max, *value), *value});
  }
  return job.varied.empty() ? std::nullopt : std::optional(std::move(job));
}

void Fitting::take(FitFound found, std::vector<Setting> changes) {
  found_ = std::move(found);
  changes_ = std::move(changes);
}

const FitFound* Fitting::found(const std::vector<Setting>& changes) const {
  return found_ && changes_ == changes ? &*found_ : nullptr;
}

}  // namespace dolp::explore
