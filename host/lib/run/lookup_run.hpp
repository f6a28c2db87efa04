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

/// Looks up points in a table. A missing column takes the only value of its axis, or else the value in the table's
/// scene, `scene`. If the table lacks an axis of n, k or wavelength, a column of it must have the value of that scene.
/// Errors: InputError that names the point, the column, the value and what the table has; Cancelled.
std::vector<PointResult> lookup_points(const TableLookup& lookup, const SceneValues& scene, const Points& points,
                                       const Progress& progress);

/// A forecast of the error of lookups that interpolate along one axis of a grid.
struct AxisForecast {
  Axis axis = Axis::kTheta;
  std::size_t values = 0;  ///< number of values of the axis in the grid
  /// Largest absolute error of DOLP that lookups state at the examined positions if only this axis is interpolated.
  /// Infinite with fewer than four values.
  double error = 0.0;
  double wanted = 0.0;  ///< largest acceptable `error`: the share of the tolerance for this axis
  /// Number of values of the axis for which the error is at most `wanted`; 0 if it is above kMostForecastValues.
  std::size_t needed_values = 0;
};
inline constexpr std::size_t kMostForecastValues = 10'000;

/// Forecasts for the axes of the scene's grid that have more than one value. For each axis, the CPU computes the table
/// values around a few cells, and a lookup in the middle of each cell states its error. This is repeated with 8, 16,
/// 32, ... values of the axis, spaced as in the grid, until the error is at most `wanted`. The order of the
/// interpolation then gives the number of values that is needed.
/// Accuracy: half of needed_values is too few for most points (test LookupForecast_TablesOfTheAdvisedDensity_*). The
/// forecast misses features that are narrower than the distance of the examined cells.
std::vector<AxisForecast> lookup_forecast(const SceneValues& scene, const EffectPlan& plan);

}  // namespace dolp
