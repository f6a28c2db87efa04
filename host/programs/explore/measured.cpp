#include "explore/measured.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.hpp"

namespace dolp::explore {

Plotted plotted(Observable observable) {
  constexpr std::array kInOrder = {Plotted::kDolp, Plotted::kSignedDolp, Plotted::kEmissivityS, Plotted::kEmissivityP};
  return kInOrder.at(static_cast<std::size_t>(observable));
}

MeasuredData read_measured(const std::string& path) {
  check_named_file(path, path + ": ");
  return MeasuredData::read(path);
}

void Residuals::load(MeasuredData data) {
  if (!data.settings.empty()) {
    throw InputError(data.name + ": measured points take the window's scene; KEY=VALUE beside them is for dolp fit");
  }
  data_ = std::move(data);
  loaded_for_ = scene_;
  ++loads_;
}

void Residuals::follow(const std::string& key, const Scene& scene) {
  scene_ = scene;
  if (!data_) return;
  std::vector<double> theta_deg, wavelength_um;
  for (const Measurement& point : data_->measurements) {
    theta_deg.push_back(point.theta_deg);
    if (point.wavelength_um) wavelength_um.push_back(*point.wavelength_um);
  }
  PointList list = points_at(scene, std::move(theta_deg));
  if (!wavelength_um.empty()) list["wavelength_um"] = std::move(wavelength_um);
  model_.follow({.key = fmt::format("measured {} {}", loads_, key), .scene = scene, .list = list, .keep_all = true});
}

std::vector<Measurement> Residuals::measured(Plotted quantity) const {
  std::vector<Measurement> points = data_ ? data_->measurements : std::vector<Measurement>();
  std::erase_if(points, [&](const Measurement& point) { return plotted(point.observable) != quantity; });
  return points;
}

std::vector<Measurement> Residuals::residuals(Plotted quantity) const {
  std::vector<Measurement> residuals;
  if (!is_known()) return residuals;
  const std::vector<Point> model = model_.points();
  for (std::size_t i = 0; i < model.size(); ++i) {
    Measurement residual = data_->measurements[i];
    residual.value -= described(quantity).value(model[i]);
    if (plotted(residual.observable) == quantity && std::isfinite(residual.value)) residuals.push_back(residual);
  }
  return residuals;
}

std::optional<double> residual_rms(const std::vector<Measurement>& residuals) {
  if (residuals.empty()) return std::nullopt;
  double sum = 0.0;
  for (const Measurement& residual : residuals) sum += residual.value * residual.value;
  return std::sqrt(sum / static_cast<double>(residuals.size()));
}

FitRange fit_range(const FitMarks& marks, const Scene& scene, const Control& control, double value) {
  constexpr double kLeastK = 1e-3;  // above 0, so that the fit can search k on a logarithmic scale
  const std::string& key = control.key->key;
  const auto marked = marks.find(key);
  if (marked != marks.end() && marked->second) {
    FitRange typed = *marked->second;
    typed.start = std::clamp(value, typed.low, typed.high);
    return typed;
  }
  const Scale slider = range_in(scene, control);
  const double low = key.ends_with(".k") ? kLeastK : std::min(slider.from, value);
  return {key, low, std::max(slider.to, value), std::max(low, value)};
}

std::size_t nearest_minimum(const Fit& fit, const FitJob& job) {
  const auto distance = [&](const FitMinimum& minimum) {
    double sum = 0.0;
    for (std::size_t j = 0; j < job.vary.size(); ++j) {
      const FitRange& range = job.vary[j];
      sum += std::pow(range.coordinate(minimum.values[j]) - range.coordinate(range.start.value()), 2);
    }
    return sum;
  };
  return static_cast<std::size_t>(std::ranges::min_element(fit.minima, {}, distance) - fit.minima.begin());
}

std::string fit_text(const Fit& fit, std::size_t chosen) {
  std::string text =
      fmt::format("χ² {:.4g}, {} degrees of freedom", fit.minima[chosen].chi_square, fit.degrees_of_freedom);
  if (fit.p_value && chosen == 0) text += fmt::format(", p {:.2g} ({})", *fit.p_value, fit.fit_quality);
  if (fit.minima.size() > 1) text += fmt::format("; of {} minima the nearest to the start", fit.minima.size());
  if (chosen > 0) text += fmt::format(", the lowest has χ² {:.4g}", fit.minima.front().chi_square);
  return text;
}

std::string interval_text(const FitInterval& interval) {
  const auto end = [](const std::optional<double>& value) { return value ? fmt::format("{:.4g}", *value) : "open"; };
  return end(interval.low) + " to " + end(interval.high);
}

}  // namespace dolp::explore
