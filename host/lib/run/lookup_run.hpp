// Interpolation of a table at scattered points, and a forecast of the density that this needs.
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

/// Looks up a table at points. If points lack sigma, q or wavelength, the values of the table's `scene` are used.
/// An axis of one value needs no column. n, k and wavelength must be the table's if it has no axis of them.
/// Errors: InputError that names the point, column, value and what the table has; Cancelled when `progress` returns
/// false.
std::vector<PointResult> lookup_points(const TableLookup& lookup, const SceneValues& scene, const Points& points,
                                       const Progress& progress);

/// One axis of a grid.
struct AxisForecast {
  Axis axis = Axis::kTheta;
  std::size_t values = 0;  ///< values that the grid has
  /// Absolute error of DOLP that a lookup states along this axis only, at the worst of the examined places; infinite
  /// with fewer than four values.
  double error = 0.0;
  double wanted = 0.0;            ///< share of the tolerance that the axis may take
  std::size_t needed_values = 0;  ///< values that reach this share; 0: more than kMostForecastValues
};
inline constexpr std::size_t kMostForecastValues = 10'000;

/// Forecasts for the axes of the scene's grid that have more than one value. The values around a few cells of each axis
/// are computed on the CPU and looked up between them: with the grid's values, and with 8, 16, 32, ... values in the
/// same kind of steps until the error is small enough. From there the order of the interpolation gives the number.
/// Accuracy: half the number is too few for most points (test LookupForecast_TablesOfTheAdvisedDensity_*). Features
/// narrower than the examined cells stay undetected.
std::vector<AxisForecast> lookup_forecast(const SceneValues& scene, const EffectPlan& plan);

}  // namespace dolp
