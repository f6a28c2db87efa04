#include "explore/heat_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "explore/curve.hpp"
#include "explore/parameters.hpp"

namespace dolp::explore {
namespace {

constexpr NumberRange kSmithQ{1.6, 20.0};  // smith needs more than 1.5

MapAxis axis_of(AxisKind kind, const std::vector<double>& grid, const NumberRange& fallback, bool is_log) {
  const auto [low, high] = std::ranges::minmax_element(grid);
  const bool has_range = *low < *high && (!is_log || *low > 0.0);
  if (has_range) return {kind, *low, *high, is_log};
  return {kind, fallback.min, fallback.max, is_log};
}

}  // namespace

double MapAxis::value(double position) const {
  if (position <= 0.0) return from;
  if (position >= 1.0) return to;
  return is_log ? from * std::pow(to / from, position) : from + position * (to - from);
}

double MapAxis::position(double value) const {
  return is_log ? std::log(value / from) / std::log(to / from) : (value - from) / (to - from);
}

MapAxis suggested_axis(AxisKind kind, const Scene& scene, double theta_max_deg) {
  switch (kind) {
    case AxisKind::kTheta:
      return {kind, 0.0, theta_max_deg, false};
    case AxisKind::kSigma:
      return axis_of(kind, scene.grid.sigma, parameter("surface.sigma").slider, true);
    case AxisKind::kQ:
      break;
  }
  const NumberRange slider = scene.surface.needs_mean_slope() ? kSmithQ : parameter("surface.q").slider;
  return axis_of(kind, scene.grid.q, slider, true);
}

const char* axis_label(AxisKind kind) {
  constexpr std::array kLabels = {"θ [°]", "σ", "q"};
  return kLabels[static_cast<std::size_t>(kind)];
}

void HeatMap::follow(const std::string& key, const Scene& scene, bool keep_all, const MapAxis& x, const MapAxis& y,
                     double theta_deg) {
  if (x != x_ || y != y_) {
    // Old results along new axes would be wrong ones.
    results_ = {};
    shown_key_.clear();
    ++version_;
  }
  key_ = key;
  scene_ = scene;
  keep_all_ = keep_all;
  x_ = x;
  y_ = y;
  theta_deg_ = theta_deg;
}

std::string HeatMap::key_of(std::size_t level) const {
  return "map " + std::to_string(kLevels[level].count) + ' ' + key_;
}

SceneEntries HeatMap::grid(const std::vector<double>& x, const std::vector<double>& y) const {
  std::vector<double> theta_deg{theta_deg_}, sigma{scene_.surface.sigma}, q{scene_.surface.q};
  for (const auto& [axis, values] : {std::pair{&x_, &x}, std::pair{&y_, &y}}) {
    if (axis->kind == AxisKind::kTheta) theta_deg = *values;
    if (axis->kind == AxisKind::kSigma) sigma = *values;
    if (axis->kind == AxisKind::kQ) q = *values;
  }
  return SceneEntries::grid(theta_deg, sigma, q);
}

Job HeatMap::job(std::size_t level) const {
  const Level& of = kLevels[level];
  Job job;
  job.key = key_of(level);
  job.scene = scene_;
  job.scene.accuracy.tolerance = std::max(of.tolerance, scene_.accuracy.tolerance);
  job.keep_all = keep_all_;
  std::vector<double> x, y;
  for (std::size_t i = 0; i < of.count; ++i) {
    const double position = static_cast<double>(i) / static_cast<double>(of.count - 1);
    x.push_back(x_.value(position));
    y.push_back(y_.value(position));
  }
  job.entries = grid(x, y);
  for (auto first = y.begin(); first != y.end(); first += static_cast<std::ptrdiff_t>(of.batch)) {
    job.parts.push_back(grid(x, {first, first + static_cast<std::ptrdiff_t>(of.batch)}));
  }
  return job;
}

std::optional<Job> HeatMap::wanted(std::size_t level) const {
  const std::size_t all = kLevels[level].count * kLevels[level].count;
  if (key_.empty() || (shown_key_ == key_ && results_[level].size() == all)) return std::nullopt;
  return job(level);
}

bool HeatMap::take(const JobPart& news) {
  for (std::size_t level = 0; level < kLevels.size(); ++level) {
    if (news.key != key_of(level)) continue;
    if (shown_key_ != key_) results_ = {};
    shown_key_ = key_;
    // Parts are grids, in which the last of theta, sigma and q is the fastest, whatever axis it is on.
    const std::size_t columns = kLevels[level].count;
    const std::size_t rows = news.results.size() / columns;
    for (std::size_t i = 0; i < news.results.size(); ++i) {
      const std::size_t place = x_.kind > y_.kind ? i : (i % columns) * rows + i / columns;
      results_[level].push_back(news.results[place]);
    }
    ++version_;
    return true;
  }
  return false;
}

bool HeatMap::is_finished() const {
  return shown_key_ == key_ && results_.back().size() == kLevels.back().count * kLevels.back().count;
}

std::size_t HeatMap::finished_count() const {
  std::size_t finest = 0;
  for (std::size_t level = 0; level < kLevels.size(); ++level) {
    const std::size_t count = kLevels[level].count;
    if (results_[level].size() == count * count) finest = count;
  }
  return finest;
}

double HeatMap::progress() const {
  double done = 0.0;
  double all = 0.0;
  for (std::size_t level = 0; level < kLevels.size(); ++level) {
    all += static_cast<double>(kLevels[level].count * kLevels[level].count);
    if (shown_key_ == key_) done += static_cast<double>(results_[level].size());
  }
  return done / all;
}

MapField HeatMap::field(Quantity quantity) const {
  MapField field;
  std::size_t finest = 0;
  for (std::size_t level = 0; level < kLevels.size(); ++level) {
    if (!results_[level].empty()) finest = level;
  }
  if (results_[finest].empty()) return field;
  const std::size_t count = kLevels[finest].count;
  field.count = count;
  field.min = std::numeric_limits<double>::infinity();
  field.max = -field.min;
  for (std::size_t row = 0; row < count; ++row) {
    for (std::size_t column = 0; column < count; ++column) {
      std::size_t level = finest;
      const auto place = [&] {
        const std::size_t last = kLevels[level].count - 1;
        const auto nearest = [&](std::size_t i) { return (2 * i * last + count - 1) / (2 * (count - 1)); };
        return nearest(row) * kLevels[level].count + nearest(column);
      };
      while (level > 0 && place() >= results_[level].size()) --level;
      const PointResult& result = results_[level][place()];
      const double value = value_of(quantity, result);
      const bool good = is_good(result) && std::isfinite(value);
      field.values.push_back(value);
      field.is_good.push_back(good ? 1 : 0);
      if (!good) continue;
      field.min = std::min(field.min, value);
      field.max = std::max(field.max, value);
    }
  }
  return field;
}

}  // namespace dolp::explore
