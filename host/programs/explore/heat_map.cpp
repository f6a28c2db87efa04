#include "explore/heat_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "explore/parameters.hpp"

namespace dolp::explore {
namespace {

constexpr SliderRange kSmithQ{1.6, 20.0};  // smith needs more than 1.5

MapAxis axis_of(AxisKind kind, const std::vector<double>& grid, const SliderRange& fallback, bool is_log) {
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
      return axis_of(kind, scene.numbers("grid.sigma"), parameter("surface.sigma").slider, true);
    case AxisKind::kQ:
      break;
  }
  const bool is_smith = scene.word("surface.masking") == "smith" && scene.word("surface.distribution") == "cauchy";
  const SliderRange slider = is_smith ? kSmithQ : parameter("surface.q").slider;
  return axis_of(kind, scene.numbers("grid.q"), slider, true);
}

const char* axis_label(AxisKind kind) {
  constexpr std::array kLabels = {"θ [°]", "σ", "q"};
  return kLabels[static_cast<std::size_t>(kind)];
}

void HeatMap::follow(const std::string& key, const Scene& scene, bool keep_all, const MapAxis& x, const MapAxis& y,
                     double theta_deg) {
  if (x != x_ || y != y_) {
    // Old results along new axes would be wrong ones.
    points_ = {};
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

PointList HeatMap::rows(std::size_t level, std::size_t first) const {
  const Level& of = kLevels[level];
  const auto values = [&](const MapAxis& axis, std::size_t from, std::size_t count) {
    std::vector<double> some;
    const double last = static_cast<double>(of.count - 1);
    for (std::size_t i = from; i < from + count; ++i) some.push_back(axis.value(static_cast<double>(i) / last));
    return some;
  };
  PointList list = points_at(scene_, {theta_deg_});
  const std::array<std::vector<double>*, 3> columns = {&list.theta_deg, &list.sigma, &list.q};
  *columns[static_cast<std::size_t>(x_.kind)] = values(x_, 0, of.count);
  *columns[static_cast<std::size_t>(y_.kind)] = values(y_, first, of.batch);
  list.is_grid = true;
  return list;
}

Job HeatMap::job(std::size_t level) const {
  Job job{.key = key_of(level), .scene = scene_, .parts = {}, .tolerance = kLevels[level].tolerance};
  job.keep_all = keep_all_;
  for (std::size_t row = 0; row < kLevels[level].count; row += kLevels[level].batch) {
    job.parts.push_back(rows(level, row));
  }
  return job;
}

std::optional<Job> HeatMap::wanted(std::size_t level) const {
  const std::size_t all = kLevels[level].count * kLevels[level].count;
  if (key_.empty() || (shown_key_ == key_ && points_[level].size() == all)) return std::nullopt;
  return job(level);
}

bool HeatMap::take(const JobPart& news) {
  for (std::size_t level = 0; level < kLevels.size(); ++level) {
    if (news.key != key_of(level)) continue;
    if (shown_key_ != key_) points_ = {};
    shown_key_ = key_;
    // On a grid the last of theta, sigma and q is the fastest, whatever axis it is on.
    const std::size_t columns = kLevels[level].count;
    const std::size_t rows = news.points.size() / columns;
    for (std::size_t i = 0; i < news.points.size(); ++i) {
      points_[level].push_back(news.points[x_.kind > y_.kind ? i : (i % columns) * rows + i / columns]);
    }
    ++version_;
    return true;
  }
  return false;
}

bool HeatMap::is_finished() const {
  return shown_key_ == key_ && points_.back().size() == kLevels.back().count * kLevels.back().count;
}

std::size_t HeatMap::finished_count() const {
  std::size_t finest = 0;
  for (std::size_t level = 0; level < kLevels.size(); ++level) {
    const std::size_t count = kLevels[level].count;
    if (points_[level].size() == count * count) finest = count;
  }
  return finest;
}

double HeatMap::progress() const {
  double done = 0.0;
  double all = 0.0;
  for (std::size_t level = 0; level < kLevels.size(); ++level) {
    all += static_cast<double>(kLevels[level].count * kLevels[level].count);
    if (shown_key_ == key_) done += static_cast<double>(points_[level].size());
  }
  return done / all;
}

MapField HeatMap::field(Plotted quantity) const {
  MapField field;
  std::size_t finest = 0;
  for (std::size_t level = 0; level < kLevels.size(); ++level) {
    if (!points_[level].empty()) finest = level;
  }
  if (points_[finest].empty()) return field;
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
      while (level > 0 && place() >= points_[level].size()) --level;
      const Point& point = points_[level][place()];
      const double value = value_of(quantity, point);
      const bool good = is_good(point) && std::isfinite(value);
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
