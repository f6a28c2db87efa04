// How densely the axes of a table must lie for a lookup between them.
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
  /// Of DOLP, absolute: what a lookup states to leave out along this axis alone, at the worst of the places looked at;
  /// infinite with fewer than four values.
  double error = 0.0;
  double wanted = 0.0;            ///< its share of the tolerance, of which the entries have one too
  std::size_t needed_values = 0;  ///< with which it is about that; 0: with none up to kMostForecastValues
};
inline constexpr std::size_t kMostForecastValues = 10'000;

/// The axes of the scene's grid that have more than one value. Some short stretches of each axis are computed on the
/// CPU and looked up between their values, with the grid's values and with others in the same kind of steps until the
/// error is what is wanted. An estimate: what is narrower than these stretches see stays unseen.
std::vector<AxisForecast> lookup_forecast(const SceneValues& scene, const EffectPlan& plan);

}  // namespace dolp
