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

/// Looks up points in a table. Missing columns take the only value of their axis, or else the value of the table's
/// `scene`. If the table lacks an axis of n, k or wavelength, the points must have the value of the table. Errors:
/// InputError that names the point, column, value and what the table has; Cancelled.
std::vector<PointResult> lookup_points(const TableLookup& lookup, const SceneValues& scene, const Points& points,
                                       const Progress& progress);

/// Forecast of lookups along one axis of a grid.
struct AxisForecast {
  Axis axis = Axis::kTheta;
  std::size_t values = 0;  ///< number of values that the grid has
  /// Largest absolute error of DOLP that lookups state if only this axis is interpolated, at the examined positions.
  /// Infinite with fewer than four values.
  double error = 0.0;
  double wanted = 0.0;  ///< error that the axis may have: its share of the tolerance
  /// Number of values with which the error is at most `wanted`; 0 if it is above kMostForecastValues.
  std::size_t needed_values = 0;
};
inline constexpr std::size_t kMostForecastValues = 10'000;

/// Forecasts for the axes of the scene's grid that have more than one value. For each axis, the CPU computes the values
/// around a few cells, and a lookup in the middle of each cell states its error. This is repeated with 8, 16, 32, ...
/// values, spaced as in the grid, until the error is small enough. The number of values that is needed then follows
/// from the order of the interpolation.
/// Accuracy: half of needed_values is too few for most points (test LookupForecast_TablesOfTheAdvisedDensity_*).
/// Features that are narrower than the distance of the examined cells stay undetected.
std::vector<AxisForecast> lookup_forecast(const SceneValues& scene, const EffectPlan& plan);

}  // namespace dolp
