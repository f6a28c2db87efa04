#include "run/lookup_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "base/numbers.hpp"
#include "base/parallel_ranges.hpp"
#include "base/text.hpp"
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "model/slopes.hpp"
#include "run/scene_run.hpp"
#include "run/scene_table.hpp"

namespace dolp {
namespace {

std::optional<double> value_of(const SceneValues& scene, Axis axis) {
  const Surface& surface = scene.surface;
  AxisArray<std::optional<double>> values;
  values[Axis::kWavelength] = scene.spectrum.min_um;
  values[Axis::kN] = surface.material.constant.n;
  values[Axis::kK] = surface.material.constant.k;
  values[Axis::kSigma] = surface.sigma;
  values[Axis::kQ] = surface.q;
  if (scene.emission) values[Axis::kTemperature] = scene.emission->temperature_K;
  return values[axis];
}

/// How messages name the values of an axis. Sigma appears as a wind speed if the points, or else the scene, have winds.
struct AxisWords {
  bool is_wind = false;
  const char* name = "";

  std::string value(double value) const {
    return is_wind ? fmt::format("{:.6g}", wind_of_sigma(value)) : format_number(value);
  }
  std::string range(const LookupAxis& axis) const {
    if (axis.size() == 1) return value(axis.min());
    return fmt::format("[{}, {}]", value(axis.min()), value(axis.max()));
  }
};

AxisWords words_of(Axis axis, const SceneValues& scene, const Points& points) {
  const bool has_winds = points[axis] ? points.has_winds : !scene.wind_m_s.empty();
  if (axis == Axis::kSigma && has_winds) return {true, kWind.column};
  return {false, description_of(axis).column};
}

std::vector<double> values_of(Axis number, const TableLookup& lookup, const SceneValues& scene, const Points& points) {
  const LookupAxis& axis = *lookup.axis(number);
  const AxisWords words = words_of(number, scene, points);
  if (description_of(number).has_labels && points[number]) return label_positions(points, number, lookup.labels());
  if (const auto& given = points[number]) {
    for (std::size_t row = 0; row < points.size(); ++row) {
      if (axis.contains((*given)[row])) continue;
      throw InputError(fmt::format("{}: {} = {}: outside the table, which has {}", points.where(row), words.name,
                                   words.value((*given)[row]), words.range(axis)));
    }
    return *given;
  }
  const std::optional<double> value = axis.size() == 1 ? axis.min() : value_of(scene, number);
  if (!value || !axis.contains(*value)) {
    throw InputError(fmt::format("{}: column \"{}\" is missing, {}", points.where(), words.name,
                                 description_of(number).has_labels ? "one of " + join(lookup.labels()[number])
                                                                   : "a number in " + words.range(axis)));
  }
  return std::vector<double>(points.size(), *value);
}

std::vector<TableLookup::Point> coordinates(const TableLookup& lookup, const SceneValues& scene, const Points& points) {
  std::vector<TableLookup::Point> result(points.size());
  for (const Axis axis : kAllAxes) {
    if (lookup.axis(axis) == nullptr) continue;
    const std::vector<double> values = values_of(axis, lookup, scene, points);
    for (std::size_t row = 0; row < points.size(); ++row) result[row][axis] = values[row];
  }
  return result;
}

void check_no_films(const Points& points) {
  if (points.films.empty()) return;
  throw InputError(fmt::format("{}: column of layer {}: the table is of one coating; dolp eval computes other ones",
                               points.where(), points.films.begin()->first.first + 1));
}

/// Refuses points with a column for an axis that the table lacks, unless the column has the value of the table's scene.
/// Refuses columns of n and k if the material of the scene depends on the wavelength.
void check_index(const TableLookup& lookup, const SceneValues& scene, const Points& points) {
  const Material& material = scene.surface.material;
  for (const Axis axis : {Axis::kMaterial, Axis::kBand, Axis::kN, Axis::kK, Axis::kWavelength, Axis::kTemperature}) {
    const auto& given = points[axis];
    if (!given || lookup.axis(axis)) continue;
    const char* const name = description_of(axis).column;
    const std::optional<double> of_scene = value_of(scene, axis);
    const bool is_dispersive = !material.is_constant() && (axis == Axis::kN || axis == Axis::kK);
    for (std::size_t row = 0; row < points.size(); ++row) {
      if (!is_dispersive && of_scene && (*given)[row] == *of_scene) continue;
      throw InputError(fmt::format("{}: {} = {}: the table {}; dolp eval computes other values", points.where(row),
                                   name, points.text_at(axis, row),
                                   is_dispersive ? "is of a material that depends on the wavelength"
                                   : of_scene    ? fmt::format("is of {} = {}", name, format_number(*of_scene))
                                                 : "has no such axis"));
    }
  }
}

constexpr std::size_t kLines = 3;        // number of examined lines of entries per axis; along a line, only it varies
constexpr std::size_t kParts = 4;        // kParts + 1 cells (see lookup_forecast) of an axis are examined
constexpr std::size_t kStretch = 8;      // values computed around a cell: a lookup reads six, and one on each side
constexpr std::size_t kLeastValues = 4;  // smallest number of values for which a lookup states an error
// A lookup reads six values along theta, sigma and q, and four along each other axis. kOrderOf...: in dense grids, the
// stated error is proportional to this power of the spacing of the values. kWeightsOf...: in the middle of a cell, the
// interpolation increases the errors of the entries at most by this factor, the sum of the absolute weights.
constexpr double kOrderOfSix = 5.0;
constexpr double kOrderOfFour = 3.0;
constexpr double kWeightsOfSix = 356.0 / 256.0;
constexpr double kWeightsOfFour = 20.0 / 16.0;

bool is_read_with_four(Axis axis) { return axis < Axis::kTheta; }

double value_at(const std::vector<double>& values, double share) {
  const double position = share * static_cast<double>(values.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(position), values.size() - 2);
  return std::lerp(values[below], values[below + 1], position - static_cast<double>(below));
}

class Forecast {
 public:
  Forecast(const SceneValues& scene, const EffectPlan& plan, double evaluations, double of_entry)
      : scene_(scene), grid_(scene.grid), plan_(plan), allowed_(evaluations), of_entry_(of_entry) {
    scene_.wind_m_s.clear();
    scene_.accuracy.may_interpolate = false;
  }

  LookupForecast all() {
    std::vector<Axis> axes;
    for (const Axis axis : kAllAxes) {
      if (grid_[axis].size() > 1 && !description_of(axis).has_labels) axes.push_back(axis);
    }
    std::vector<AxisForecast> forecasts;
    for (const Axis axis : axes) {
      double wanted = scene_.accuracy.tolerance / static_cast<double>(axes.size() + 1);
      for (const Axis other : axes) {
        if (other != axis) wanted /= is_read_with_four(other) ? kWeightsOfFour : kWeightsOfSix;
      }
      const std::size_t lines = axes.size() > 1 ? kLines : 1, values = grid_[axis].size();
      AxisForecast& forecast = forecasts.emplace_back(AxisForecast{axis, values, kNan, wanted});
      if (values < kLeastValues || has_left(values, lines)) forecast.error = error_with(axis, values, lines);
      find_needed(forecast, lines);
    }
    return {std::move(forecasts), evaluator_.report().evaluations};
  }

 private:
  void find_needed(AxisForecast& forecast, std::size_t lines) {
    const double order = is_read_with_four(forecast.axis) ? kOrderOfFour : kOrderOfSix;
    for (std::size_t values = 2 * kLeastValues; values <= kMostForecastValues; values *= 2) {
      if (!has_left(values, lines)) return;
      forecast.examined = values;
      const double error = error_with(forecast.axis, values, lines);
      if (error > forecast.wanted) continue;
      const double steps = static_cast<double>(values - 1) * std::pow(error / forecast.wanted, 1.0 / order);
      forecast.needed_values = std::clamp(static_cast<std::size_t>(std::ceil(steps)) + 1, values / 2, values);
      return;
    }
  }

  /// True if error_with() takes no more evaluations than are left.
  bool has_left(std::size_t values, std::size_t lines) const {
    const auto entries = static_cast<double>(lines * std::min(values, (kParts + 1) * kStretch));
    return evaluator_.report().evaluations + entries * of_entry_ <= allowed_;
  }

  double error_with(Axis axis, std::size_t values, std::size_t lines) {
    if (values < kLeastValues) return kInfinity;
    const auto value = [&](std::size_t position) {
      return value_at(grid_[axis], static_cast<double>(position) / static_cast<double>(values - 1));
    };
    const std::size_t length = std::min(values, kStretch);
    std::set<std::size_t> cells, positions;
    for (std::size_t i = 0; i <= kParts; ++i) {
      const std::size_t cell = i * (values - 2) / kParts;
      cells.insert(cell);
      const std::size_t first = std::min(cell - std::min(cell, kStretch / 2 - 1), values - length);
      for (std::size_t k = 0; k < length; ++k) positions.insert(first + k);
    }
    double largest = -1.0;  // stays negative if all errors are NaN
    for (std::size_t line = 0; line < lines; ++line) {
      scene_.grid = values_of_line(line);
      scene_.grid[axis].clear();
      for (const std::size_t position : positions) scene_.grid[axis].push_back(value(position));
      const TableValues table = computed_table();
      const TableLookup lookup(table, scene_, "forecast");
      TableLookup::Point point{};
      for (const Axis each : kAllAxes) point[each] = grid_[each].empty() ? 0.0 : scene_.grid[each].front();
      for (const std::size_t cell : cells) {
        point[axis] = std::midpoint(value(cell), value(cell + 1));
        const double error = lookup.at(point)[Quantity::kErrorEstimate];
        if (error > largest) largest = error;
      }
    }
    return largest < 0.0 ? kInfinity : largest;
  }

  Axes values_of_line(std::size_t line) const {
    Axes axes;
    for (const Axis axis : kAllAxes) {
      const std::vector<double>& whole = grid_[axis];
      const std::size_t part = (line + static_cast<std::size_t>(axis)) % kLines;
      if (!whole.empty()) axes[axis] = {whole[(2 * part + 1) * whole.size() / (2 * kLines)]};
    }
    return axes;
  }

  /// The table over scene_.grid. Its error estimates are 0, so that lookups state only the error of the interpolation.
  TableValues computed_table() {
    const SceneEntries entries = grid_entries(scene_);
    TableValues table = table_part(table_layout(scene_, plan_, scene_.grid), entries,
                                   evaluate_scene(scene_, entries, evaluator_, {}, plan_));
    std::ranges::fill(table[Quantity::kErrorEstimate], 0.0);
    std::ranges::fill(table[Quantity::kRhoErrorEstimate], 0.0);
    return table;
  }

  SceneValues scene_;  ///< the given scene, but with the grid of the line that is examined
  const Axes& grid_;   ///< the grid of the given scene
  const EffectPlan& plan_;
  double allowed_;
  double of_entry_;
  CpuEvaluator evaluator_;
};

}  // namespace

std::vector<PointResult> lookup_points(const TableLookup& lookup, const SceneValues& scene, const Points& points,
                                       const Progress& progress) {
  check_no_films(points);
  check_surface(scene, points);
  check_index(lookup, scene, points);
  const std::vector<TableLookup::Point> at = coordinates(lookup, scene, points);
  std::vector<PointResult> results(points.size());
  parallel_for(
      results.size(), [&](std::size_t i) { results[i] = lookup.at(at[i]); }, progress);
  return results;
}

LookupForecast lookup_forecast(const SceneValues& scene, const EffectPlan& plan, double evaluations, double of_entry) {
  return Forecast(scene, plan, evaluations, of_entry).all();
}

}  // namespace dolp
