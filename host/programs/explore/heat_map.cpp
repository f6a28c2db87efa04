#include "explore/heat_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "explore/parameters.hpp"

namespace dolp::explore {
namespace {

Scale range_of(const std::vector<double>& grid, const Scale& fallback) {
  const auto [low, high] = std::ranges::minmax_element(grid);
  return *low<*high&& * low> 0.0 ? Scale{*low, *high, true} : Scale{fallback.from, fallback.to, true};
}

struct Crossing {
  double x, y;
};

/// Corners of a square in turn, as offsets.
constexpr std::array<std::pair<std::size_t, std::size_t>, 4> kCorners = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

}  // namespace

MapAxis suggested_axis(Axis axis, const Scene& scene, double theta_max_deg) {
  if (axis == Axis::kTheta) return {axis, {0.0, theta_max_deg}};
  if (axis == Axis::kSigma && has_wind(scene)) {
    const auto [low, high] = std::ranges::minmax(scene.numbers("grid.wind_m_s"));
    return {axis, low < high ? Scale{low, high} : parameter("surface.wind_m_s").slider, true};
  }
  if (axis == Axis::kSigma) return {axis, range_of(scene.numbers("grid.sigma"), parameter("surface.sigma").slider)};
  return {axis, range_of(scene.numbers("grid.q"), range_in(scene, parameter("surface.q")))};
}

const char* MapAxis::label() const {
  return axis == Axis::kTheta ? "θ [°]" : axis == Axis::kQ ? "q" : is_wind ? "U [m/s]" : "σ";
}

std::string MapAxis::key() const {
  return axis == Axis::kTheta ? "" : axis == Axis::kQ ? "surface.q" : is_wind ? "surface.wind_m_s" : "surface.sigma";
}

std::vector<Segment> contour(const MapField& field, double level) {
  std::vector<Segment> segments;
  const double last = static_cast<double>(field.count) - 1.0;
  for (std::size_t row = 0; row + 1 < field.count; ++row) {
    for (std::size_t column = 0; column + 1 < field.count; ++column) {
      std::array<double, 4> value{};
      bool good = true;
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t at = (row + kCorners[i].second) * field.count + column + kCorners[i].first;
        value[i] = field.values[at] - level;
        good = good && field.is_good[at] != 0;
      }
      if (!good) continue;
      std::vector<Crossing> crossings;
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t j = (i + 1) % 4;
        if ((value[i] < 0.0) == (value[j] < 0.0)) continue;
        const double part = value[i] / (value[i] - value[j]);
        const auto between = [&](std::size_t a, std::size_t b) {
          return static_cast<double>(a) + part * (static_cast<double>(b) - static_cast<double>(a));
        };
        crossings.push_back({(static_cast<double>(column) + between(kCorners[i].first, kCorners[j].first)) / last,
                             (static_cast<double>(row) + between(kCorners[i].second, kCorners[j].second)) / last});
      }
      // Two crossings, or four around a saddle, joined in turn.
      for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
        segments.push_back({crossings[i].x, crossings[i].y, crossings[i + 1].x, crossings[i + 1].y});
      }
    }
  }
  return segments;
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
    for (std::size_t i = from; i < from + count; ++i) some.push_back(axis.scale.value(static_cast<double>(i) / last));
    return some;
  };
  PointList list = points_at(scene_, {theta_deg_});
  const auto column = [&](const MapAxis& of_axis) -> std::vector<double>& {
    return of_axis.axis == Axis::kTheta ? list.theta_deg : of_axis.axis == Axis::kSigma ? list.sigma : list.q;
  };
  column(x_) = values(x_, 0, of.count);
  column(y_) = values(y_, first, of.batch);
  list.is_grid = true;
  return list;
}

std::optional<Job> HeatMap::wanted(std::size_t level) const {
  const Level& of = kLevels[level];
  if (key_.empty() || (shown_key_ == key_ && points_[level].size() == of.count * of.count)) return std::nullopt;
  Job job{.key = key_of(level), .scene = scene_, .parts = {}, .tolerance = of.tolerance, .keep_all = keep_all_};
  for (std::size_t row = 0; row < of.count; row += of.batch) job.parts.push_back(rows(level, row));
  return job;
}

bool HeatMap::take(const JobPart& news) {
  for (std::size_t level = 0; level < kLevels.size(); ++level) {
    if (news.key != key_of(level)) continue;
    const bool is_first = level == 0 && shown_key_ != key_;
    if (is_first && (std::exchange(arriving_key_, key_) != key_ || news.part == 0)) arriving_.clear();
    // On a grid the last of theta, sigma and q is the fastest, whatever axis it is on.
    const std::size_t columns = kLevels[level].count;
    const std::size_t rows = news.points.size() / columns;
    for (std::size_t i = 0; i < news.points.size(); ++i) {
      (is_first ? arriving_ : points_[level])
          .push_back(news.points[x_.axis > y_.axis ? i : (i % columns) * rows + i / columns]);
    }
    if (is_first && news.is_last) {
      points_ = {};
      points_[0] = std::exchange(arriving_, {});
      shown_key_ = key_;
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
      const double value = described(quantity).value(point);
      const bool good = point.is_good() && std::isfinite(value);
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
