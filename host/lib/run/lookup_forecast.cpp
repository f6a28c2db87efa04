#include "run/lookup_forecast.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "base/numbers.hpp"
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "run/scene_run.hpp"
#include "run/scene_table.hpp"
#include "table/table_lookup.hpp"

namespace dolp {
namespace {

constexpr std::size_t kLines = 3;    // along an axis, at different values of the others
constexpr std::size_t kParts = 4;    // of an axis, at whose ends cells are examined
constexpr std::size_t kStretch = 8;  // values around a cell: all that the error of a lookup in its middle depends on
constexpr std::size_t kLeastValues = 4;  // for which a lookup states an error
// A lookup reads six values of theta, sigma and q, and four of wavelength, n and k. In dense grids the stated error is
// a share of the change by the last of these values, and falls with this power of the spacing; the sizes of the weights
// in the middle of a cell add up to so much, which multiplies the errors along the other axes.
constexpr double kOrderOfSix = 5.0;
constexpr double kOrderOfFour = 3.0;
constexpr double kWeightsOfSix = 356.0 / 256.0;
constexpr double kWeightsOfFour = 20.0 / 16.0;

bool is_read_with_four(Axis axis) { return axis < Axis::kTheta; }

/// The value of an axis at a share of it from 0 to 1, mostly between two of its values.
double value_at(const std::vector<double>& values, double share) {
  const double position = share * static_cast<double>(values.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(position), values.size() - 2);
  return std::lerp(values[below], values[below + 1], position - static_cast<double>(below));
}

class Forecast {
 public:
  Forecast(const SceneValues& scene, const EffectPlan& plan) : scene_(scene), grid_(scene.grid), plan_(plan) {
    scene_.wind_m_s.clear();
    scene_.accuracy.may_interpolate = false;
  }

  std::vector<AxisForecast> all() {
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
      forecasts.push_back({axis, values, error_with(axis, values, lines), wanted, needed(axis, wanted, lines)});
    }
    return forecasts;
  }

 private:
  /// The number of values that keeps the error at `wanted`; 0 without one.
  std::size_t needed(Axis axis, double wanted, std::size_t lines) {
    const double order = is_read_with_four(axis) ? kOrderOfFour : kOrderOfSix;
    for (std::size_t values = 2 * kLeastValues; values <= kMostForecastValues; values *= 2) {
      const double error = error_with(axis, values, lines);
      if (error > wanted) continue;
      const double steps = static_cast<double>(values - 1) * std::pow(error / wanted, 1.0 / order);
      return std::clamp(static_cast<std::size_t>(std::ceil(steps)) + 1, values / 2, values);
    }
    return 0;
  }

  /// The largest error of a lookup along an axis of so many values, in the middle of the examined cells.
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
    double largest = -1.0;  // NaN is not larger
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

  /// One value of each axis.
  Axes values_of_line(std::size_t line) const {
    Axes axes;
    for (const Axis axis : kAllAxes) {
      const std::vector<double>& whole = grid_[axis];
      const std::size_t part = (line + static_cast<std::size_t>(axis)) % kLines;
      if (!whole.empty()) axes[axis] = {whole[(2 * part + 1) * whole.size() / (2 * kLines)]};
    }
    return axes;
  }

  /// The table of the scene's grid, as if its entries had no error: only the error of the interpolation remains.
  TableValues computed_table() {
    const SceneEntries entries = grid_entries(scene_);
    TableValues table = table_part(table_layout(scene_, plan_, scene_.grid), entries,
                                   evaluate_scene(scene_, entries, evaluator_, {}, plan_));
    std::ranges::fill(table[Quantity::kErrorEstimate], 0.0);
    std::ranges::fill(table[Quantity::kRhoErrorEstimate], 0.0);
    return table;
  }

  SceneValues scene_;  ///< with the grid of a line
  const Axes& grid_;   ///< the whole grid
  const EffectPlan& plan_;
  CpuEvaluator evaluator_;
};

}  // namespace

std::vector<AxisForecast> lookup_forecast(const SceneValues& scene, const EffectPlan& plan) {
  return Forecast(scene, plan).all();
}

}  // namespace dolp
