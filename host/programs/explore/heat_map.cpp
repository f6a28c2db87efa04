#include "explore/heat_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "explore/scene_edits.hpp"

namespace dolp::explore {
namespace {

struct AxisOfNumber {
  std::string name, key;
  std::optional<Scale> range = {};  ///< range of the map axis; if empty, the range of the slider for `key`
};

/// All axes except the zenith. Sigma and the wind speed have the same name, because no scene has sliders for both.
const std::vector<AxisOfNumber>& axes_of_numbers() {
  static const std::vector<AxisOfNumber> all = [] {
    std::vector<AxisOfNumber> axes = {{"sigma", "surface.sigma"},
                                      {"sigma", "surface.wind_m_s"},
                                      {"q", "surface.q"},
                                      {"n", "surface.n"},
                                      {"k", "surface.k", Scale{1e-3, 100.0, true}},
                                      {"wavelength", "spectrum.wavelength_um"},
                                      {"temperature", "emission.temperature_K"},
                                      {"view zenith", "geometry.view_zenith_deg"},
                                      {"azimuth", "geometry.relative_azimuth_deg", Scale{0.0, 180.0}},
                                      {"sigma cross", kSigmaCross},
                                      {"surface azimuth", kSurfaceAzimuth}};
    for (const Key& key : keys()) {
      if (key.key.ends_with(".thickness_um"))
        axes.push_back({fmt::format("film {}", key.layer), key.key, Scale{1e-2, 10.0, true}});
    }
    return axes;
  }();
  return all;
}

/// The range of the values that the scene's grid has on `axis`. Without two different values, returns axis.scale.
Scale grid_range(const Scene& scene, const MapAxis& axis) {
  const bool is_film = axis.key.starts_with("surface.coating");
  const std::vector<double> grid = is_film ? std::vector<double>() : scene.numbers("grid." + axis.column());
  if (grid.empty()) return axis.scale;
  const auto [low, high] = std::ranges::minmax(grid);
  const bool has_range = low < high && !(axis.scale.is_log && low <= 0.0);
  return has_range ? Scale{low, high, axis.scale.is_log} : axis.scale;
}

struct Corner {
  std::size_t x, y;
};
constexpr std::array<Corner, 4> kCorners = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};  // counterclockwise

/// Adds the contour lines in the square of the map whose lower left corner is the point (column, row) of `field`.
void add_lines(const MapField& field, double level, std::size_t column, std::size_t row, std::vector<Segment>& lines) {
  std::array<double, 4> value{};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t at = (row + kCorners[i].y) * field.count + column + kCorners[i].x;
    value[i] = field.values[at] - level;
    if (std::isnan(value[i])) return;
  }
  const auto [low, high] = std::ranges::minmax(value);
  if (described(field.quantity).jumps(low, high)) return;
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
  // Two crossings on the border of the square give one line; four crossings, around a saddle point, give two lines.
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
    lines.push_back({crossings[i].first, crossings[i].second, crossings[i + 1].first, crossings[i + 1].second});
}

}  // namespace

std::vector<MapAxis> map_axes(const Scene& scene, double theta_max_deg) {
  std::vector<MapAxis> axes = {{.scale = {0.0, theta_max_deg}}};
  for (const AxisOfNumber& number : axes_of_numbers()) {
    const std::optional<double> value = control(number.key).value(scene);
    if (!value && number.name.starts_with("film")) break;
    if (!value) continue;
    MapAxis axis{number.name, control(number.key).label_with_unit(), number.key};
    axis.scale = number.range.value_or(range_in(scene, control(number.key)));
    axis.scale = grid_range(scene, axis).including(*value);
    axes.push_back(axis);
  }
  return axes;
}

std::size_t MapAxis::rank() const {
  const std::string table_column = column() == kWind.column ? describe(Axis::kSigma).column : column();
  const auto found =
      std::ranges::find_if(kAxes, [&](const AxisDescription& axis) { return table_column == axis.column; });
  return found == kAxes.end() ? 0 : 1 + static_cast<std::size_t>(found - kAxes.begin());
}

Scale known_part(const Scene& scene, const MapAxis& axis) {
  constexpr int kHalvings = 8;
  const double inside = scene.number(axis.key).value();
  Scale range = axis.scale;
  if (const auto known = built_in_material(scene))
    range = {std::max(range.from, known->from_um), std::min(range.to, known->to_um), range.is_log};
  for (double Scale::*end : {&Scale::from, &Scale::to}) {
    for (int i = 0; i < kHalvings && !refusal(scene, axis, {range.*end, range.*end}).empty(); ++i)
      range.*end = i + 1 < kHalvings ? std::sqrt(range.*end * inside) : inside;
  }
  return range;
}

std::string refusal(const Scene& scene, const MapAxis& axis, const Scale& range) {
  for (const double end : {range.from, range.to}) {
    try {
      if (!axis.key.empty()) {
        static_cast<void>(scene.with(axis.key, end));
      } else if (!describe(Axis::kTheta).range.contains(end)) {
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
    points_ = {};  // the old points belong to other axes
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

PointList HeatMap::lines(std::size_t level, std::size_t first) const {
  const auto [count, tolerance, batch] = kLevels[level];
  const MapAxis& across = is_turned() ? y_ : x_;
  const MapAxis& along = is_turned() ? x_ : y_;
  const std::vector<double> all_across = across.scale.values(count), all_along = along.scale.values(count);
  std::vector<double> values_across, values_along;
  for (std::size_t line = first; line < first + batch; ++line) {
    values_across.insert(values_across.end(), count, all_across[line]);
    values_along.insert(values_along.end(), all_along.begin(), all_along.end());
  }
  PointList list = points_at(scene_, {theta_deg_});
  list[across.column()] = std::move(values_across);
  list[along.column()] = std::move(values_along);
  return list;
}

std::string HeatMap::job_key(std::size_t level, std::size_t first) const {
  return fmt::format("map {} from {}, {}", kLevels[level].count, first, key_);
}

std::vector<Job> HeatMap::wanted(std::size_t level) const {
  std::vector<Job> jobs;
  if (key_.empty() || (level > 0 && !is_current())) return jobs;
  const auto [count, tolerance, batch] = kLevels[level];
  std::vector<Setting> settings;
  // Points can have a sigma_cross only if their scene has one.
  if (x_.key == kSigmaCross || y_.key == kSigmaCross)
    settings.push_back({kSigmaCross, control(kSigmaCross).value(scene_).value()});
  for (std::size_t first = known(level); first < count; first += batch) {
    jobs.push_back({.key = job_key(level, first),
                    .scene = scene_,
                    .settings = settings,
                    .list = lines(level, first),
                    .tolerance = tolerance,
                    .keep_all = keep_all_});
  }
  return jobs;
}

bool HeatMap::take(const JobResult& news) {
  const std::size_t levels = is_current() ? kLevels.size() : 1;
  for (std::size_t level = 0; level < levels; ++level) {
    if (news.key != job_key(level, known(level))) continue;
    if (!is_current() && std::exchange(arriving_key_, key_) != key_) arriving_.clear();
    std::vector<Point>& points = is_current() ? points_[level] : arriving_;
    points.insert(points.end(), news.points.begin(), news.points.end());
    ++version_;
    if (arriving_.size() == entries(0)) {
      points_ = {std::exchange(arriving_, {})};
      shown_key_ = key_;
    }
    return true;
  }
  return false;
}

const Point& HeatMap::point_at(std::size_t finest, std::size_t row, std::size_t column) const {
  const std::size_t steps = kLevels[finest].count - 1;
  for (std::size_t level = finest;; --level) {
    const std::size_t last = kLevels[level].count - 1;
    const auto nearest = [&](std::size_t i) { return (2 * i * last + steps) / (2 * steps); };
    const auto [line, place] = is_turned() ? std::pair(row, column) : std::pair(column, row);
    const std::size_t position = nearest(line) * kLevels[level].count + nearest(place);
    if (level == 0 || position < points_[level].size()) return points_[level][position];
  }
}

MapField HeatMap::field(Plotted quantity) const {
  std::size_t finest = kLevels.size() - 1;
  while (finest > 0 && points_[finest].empty()) --finest;
  if (points_[finest].empty()) return {.quantity = quantity};
  const std::size_t count = kLevels[finest].count;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  MapField field{.quantity = quantity, .count = count, .values = {}, .min = kInfinity, .max = -kInfinity};
  for (std::size_t i = 0; i < count * count; ++i) {
    const Point& point = point_at(finest, i / count, i % count);
    const double value = described(quantity).value(point);
    const bool is_good = point.is_good() && std::isfinite(value);
    field.values.push_back(is_good ? value : std::numeric_limits<double>::quiet_NaN());
    if (!is_good) continue;
    field.min = std::min(field.min, value);
    field.max = std::max(field.max, value);
  }
  return field;
}

}  // namespace dolp::explore
