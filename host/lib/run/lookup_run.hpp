#pragma once

#include <dolp/errors.hpp>
#include <vector>

#include <cstddef>
#include <dolp/results.hpp>
#include "base/numbers.hpp"
#include "model/scene_entry.hpp"
#include "plan/effects.hpp"
#include "scene/points.hpp"
#include "scene/scene.hpp"
#include "table/table_lookup.hpp"

namespace dolp {

/// Looks up points in a table that was made from `scene`. If the points lack the column of an axis, they get the only
/// value of the axis, or else the value in the scene. A column for an axis that the table lacks must have the value in
/// the scene. Errors: InputError that names the point, the column, the value and what the table has; Cancelled.
std::vector<PointResult> lookup_points(const TableLookup& lookup, const SceneValues& scene, const Points& points,
                                       const Progress& progress);

struct AxisForecast {
  Axis axis = Axis::kTheta;
  std::size_t values = 0;  ///< number of values of the axis in the grid
  /// Largest error of DOLP in the examined cells from interpolation along this axis. Infinite if `values` is below 4.
  /// NaN if the forecast did not examine the grid.
  double error = 0.0;
  double wanted = 0.0;  ///< largest acceptable `error`: the part of the tolerance that this axis may use up
  /// Number of values of the axis for which the error is at most `wanted`; 0 if it is above `examined`.
  std::size_t needed_values = 0;
  std::size_t examined = 0;  ///< largest number of values that the forecast examined, at most kMostForecastValues
};
inline constexpr std::size_t kMostForecastValues = 10'000;

struct LookupForecast {
  std::vector<AxisForecast> axes;
  double evaluations = 0.0;  ///< integrand evaluations that the forecast took
};

/// A forecast for each axis of the grid that has several numbers as values. A cell is an interval between neighbouring
/// values. The CPU computes the table near a few cells of the axis. AxisForecast::error is the largest error estimate
/// of a lookup in the middles of these cells. The forecast repeats this with 8, 16, 32, ... values until the error is
/// at most `wanted`. It misses features between these cells. It ends before it takes more than `evaluations` integrand
/// evaluations; `of_entry` is the expected number for an entry. Accuracy: with needed_values on each axis, most points
/// meet the tolerance; with half as many, most miss it (test LookupForecast_TablesOfTheAdvisedDensity_*).
LookupForecast lookup_forecast(const SceneValues& scene, const EffectPlan& plan, double evaluations = kInfinity,
                               double of_entry = 0.0);

}  // namespace dolp
