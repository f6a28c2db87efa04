// Forecast of the density that a table's axes need for a lookup between them.
#pragma once

#include <cstddef>
#include <vector>

#include "model/scene_entry.hpp"
#include "plan/effects.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// One axis of a grid.
struct AxisForecast {
  Axis axis = Axis::kTheta;
  std::size_t values = 0;  ///< that the grid has
  /// Absolute error of DOLP: the lookup's stated error along this axis alone, at the worst of the examined places;
  /// infinite with fewer than four values.
  double error = 0.0;
  double wanted = 0.0;            ///< its share of the tolerance, of which the entries have one too
  std::size_t needed_values = 0;  ///< with which it is about that; 0: with none up to kMostForecastValues
};
inline constexpr std::size_t kMostForecastValues = 10'000;

/// Forecasts for the axes of the scene's grid that have more than one value. Some short stretches of each axis are
/// computed on the CPU and looked up between their values, with the grid's values and with others in the same kind of
/// steps until the error is as small as wanted. An estimate: features narrower than these stretches resolve stay
/// undetected.
std::vector<AxisForecast> lookup_forecast(const SceneValues& scene, const EffectPlan& plan);

}  // namespace dolp
