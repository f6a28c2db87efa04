#pragma once

#include <dolp/errors.hpp>
#include <vector>

#include <cstddef>
#include <dolp/results.hpp>
#include "model/scene_entry.hpp"
#include "plan/effects.hpp"
#include "scene/points.hpp"
#include "scene/scene.hpp"
#include "table/table_lookup.hpp"

namespace dolp {

/// Looks up points in a table, whose scene is `scene`. A missing column takes the only value of its axis, or else the
/// value in the scene. If the table lacks an axis, a column for this axis must have the value in the scene. Errors:
/// InputError that names the point, the column, the value and what the table has; Cancelled.
std::vector<PointResult> lookup_points(const TableLookup& lookup, const SceneValues& scene, const Points& points,
                                       const Progress& progress);

struct AxisForecast {
  Axis axis = Axis::kTheta;
  std::size_t values = 0;  ///< number of values of the axis in the grid
  /// Largest error of DOLP in the examined cells, interpolated along this axis only. Infinite if `values` is below 4.
  double error = 0.0;
  double wanted = 0.0;  ///< largest acceptable `error`: the share of the tolerance for this axis
  /// Number of values of the axis for which the error is at most `wanted`; 0 if it is above kMostForecastValues.
  std::size_t needed_values = 0;
};
inline constexpr std::size_t kMostForecastValues = 10'000;

/// A forecast for each axis of the grid that has more than one value and no labels. The CPU computes the table around a
/// few cells of the axis. A lookup in the middle of each cell states an error. The forecast then tries 8, 16, 32, ...
/// values of the axis until the error is at most `wanted`. Features narrower than the distance between the cells are
/// missed. Accuracy: with needed_values on each axis, most points meet the tolerance. With half as many values, most
/// points miss it (test LookupForecast_TablesOfTheAdvisedDensity_*).
std::vector<AxisForecast> lookup_forecast(const SceneValues& scene, const EffectPlan& plan);

}  // namespace dolp
