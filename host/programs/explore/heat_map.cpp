#include "explore/heat_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "explore/parameters.hpp"

namespace dolp::explore {
namespace {

Scale log_range_of(const std::vector<double>& grid, const Scale& fallback) {
  const auto [low, high] = std::ranges::minmax_element(grid);
  const bool has_range = low != grid.end() && *low<*high&& * low> 0.0;
  return has_range ? Scale{*low, *high, true} : Scale{fallback.from, fallback.to, true};
}

/// The corners of a square in turn.
struct Corner {
  std::size_t x, y;
};
constexpr std::array<Corner, 4> kCorners = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

/// Adds the lines within the square at (column, row).
void add_lines(const MapField& field, double level, std::size_t column, std::size_t row, std::vector<Segment>& lines) {
  std::array<double, 4> value{};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t at = (row + kCorners[i].y) * field.count + column + kCorners[i].x;
    if (field.is_good[at] == 0) return;
    value[i] = field.values[at] - level;
  }
  std::vector<std::pair<double, double>> crossings;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    if ((value[i] < 0.0) == (value[j] < 0.0)) continue;
    const double part = value[i] / (value[i] - value[j]);
    const auto between = [&](std::size_t origin, std::size_t Corner::*side) {
      const auto from = static_cast<double>(kCorners[i].*side), to = static_cast<double>(kCorners[j].*side);
      return (static_cast<double>(origin) + from + part * (to - from)) / (static_cast<double>(field.count) - 1.0);
    };
    crossings.emplace_back(between(column, &Corner::x), between(row, &Corner::y));
  }
  // Two crossings, or four around a saddle, joined in turn.
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
    lines.push_back({crossings[i].first, crossings[i].second, crossings[i + 1].first, crossings[i + 1].second});
}

}  // namespace

MapAxis suggested_axis(Axis axis, const Scene& scene, double theta_max_deg) {
  if (axis == Axis::kTheta) return {axis, {0.0, theta_max_deg}};
  if (axis == Axis::kSigma && has_wind(scene)) {
    const auto [low, high] = std::ranges::minmax(scene.numbers("grid.wind_m_s"));
    return {axis, low < high ? Scale{low, high} : parameter("surface.wind_m_s").slider, true};
  }
  if (axis == Axis::kSigma) return {axis, log_range_of(scene.numbers("grid.sigma"), parameter("surface.sigma").slider)};
  return {axis, log_range_of(scene.numbers("grid.q"), range_in(scene, parameter("surface.q")))};
}

const char* MapAxis::label() const {
  return axis == Axis::kTheta ? "θ [°]" : axis == Axis::kQ ? "q" : is_wind ? "U [m/s]" : "σ";
}

std::string MapAxis::key() const {
  return axis == Axis::kTheta ? "" : axis == Axis::kQ ? "surface.q" : is_wind ? "surface.wind_m_s" : "surface.sigma";
}

std::string refusal(const Scene& scene, const MapAxis& axis, const Scale& range) {
  for (const double end : {range.from, range.to}) {
    try {
      if (axis.axis != Axis::kTheta) {
        static_cast<void>(scene.with(axis.key(), end));
      } else if (!description_of(axis.axis).range.contains(end)) {
        return "must be numbers in [0, 90]";
      }
    } catch (const InputError& error) {
      return error.what();
    }
  }
  return {};
}

std::vector<Segment> contour(const MapField& field, double level) {
  std::vector<Segment> lines;
  for (std::size_t row = 0; row + 1 < field.count; ++row) {
    for (std::size_t column = 0; column + 1 < field.count; ++column) add_lines(field, level, column, row, lines);
  }
  return lines;
}

void HeatMap::follow(const std::string& key, const Scene& scene, bool keep_all, const MapAxis& x, const MapAxis& y,
                     double theta_deg) {
  if (x != x_ || y != y_) {
    // Old results along new axes would be wrong.
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
  const auto& [all, tolerance, batch] = kLevels[level];
  PointList list = points_at(scene_, {theta_deg_});
  const auto fill = [&, last = static_cast<double>(all - 1)](const MapAxis& axis, std::size_t from, std::size_t count) {
    std::vector<double>& column = axis.axis == Axis::kTheta   ? list.theta_deg
                                  : axis.axis == Axis::kSigma ? list.sigma
                                                              : list.q;
    column.clear();
    for (std::size_t i = from; i < from + count; ++i) column.push_back(axis.scale.value(static_cast<double>(i) / last));
  };
  fill(x_, 0, all);
  fill(y_, first, batch);
  list.is_grid = true;
  return list;
}

std::optional<Job> HeatMap::wanted(std::size_t level) const {
  if (key_.empty() || (is_current() && is_complete(level))) return std::nullopt;
  const Level& next = kLevels[level];
  Job job{.key = key_of(level), .scene = scene_, .parts = {}, .tolerance = next.tolerance, .keep_all = keep_all_};
  for (std::size_t row = 0; row < next.count; row += next.batch) job.parts.push_back(rows(level, row));
  return job;
}

bool HeatMap::take(const JobPart& news) {
  std::size_t level = 0;
  while (level < kLevels.size() && news.key != key_of(level)) ++level;
  if (level == kLevels.size()) return false;
  const bool is_first = level == 0 && !is_current();
  if (is_first && (std::exchange(arriving_key_, key_) != key_ || news.part == 0)) arriving_.clear();
  // On a grid the last of theta, sigma and q is the fastest, whatever axis it is on.
  const std::size_t columns = kLevels[level].count;
  const std::size_t rows = news.points.size() / columns;
  std::vector<Point>& points = is_first ? arriving_ : points_[level];
  for (std::size_t i = 0; i < news.points.size(); ++i)
    points.push_back(news.points[x_.axis > y_.axis ? i : (i % columns) * rows + i / columns]);
  if (is_first && news.is_last) {
    points_ = {};
    points_[0] = std::exchange(arriving_, {});
    shown_key_ = key_;
  }
  ++version_;
  return true;
}

std::size_t HeatMap::finished_count() const {
  std::size_t finest = 0;
  for (std::size_t level = 0; level < kLevels.size(); ++level) {
    if (is_complete(level)) finest = kLevels[level].count;
  }
  return finest;
}

double HeatMap::progress() const {
  std::size_t done = 0, all = 0;
  for (std::size_t level = 0; level < kLevels.size(); ++level) {
    all += entries(level);
    if (is_current()) done += points_[level].size();
  }
  return static_cast<double>(done) / static_cast<double>(all);
}

const Point& HeatMap::point_at(std::size_t finest, std::size_t row, std::size_t column) const {
  const std::size_t steps = kLevels[finest].count - 1;
  for (std::size_t level = finest;; --level) {
    const std::size_t last = kLevels[level].count - 1;
    const auto nearest = [&](std::size_t i) { return (2 * i * last + steps) / (2 * steps); };
    const std::size_t position = nearest(row) * kLevels[level].count + nearest(column);
    if (level == 0 || position < points_[level].size()) return points_[level][position];
  }
}

MapField HeatMap::field(Plotted quantity) const {
  std::size_t finest = kLevels.size() - 1;
  while (finest > 0 && points_[finest].empty()) --finest;
  if (points_[finest].empty()) return {};
  const std::size_t count = kLevels[finest].count;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  MapField field{.count = count, .values = {}, .is_good = {}, .min = kInfinity, .max = -kInfinity};
  for (std::size_t i = 0; i < count * count; ++i) {
    const Point& point = point_at(finest, i / count, i % count);
    const double value = described(quantity).value(point);
    const bool good = point.is_good() && std::isfinite(value);
    field.values.push_back(value);
    field.is_good.push_back(good ? 1 : 0);
    if (!good) continue;
    field.min = std::min(field.min, value);
    field.max = std::max(field.max, value);
  }
  return field;
}

}  // namespace dolp::explore
