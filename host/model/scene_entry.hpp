#pragma once

#include <optional>

#include "model/optical_constants.hpp"
#include "model/slopes.hpp"

namespace dolp {

/// One point of a table or of a list of points. Without an `index` of its own it has the scene's material.
struct SceneEntry {
  double theta_deg = 0.0;
  SlopeShape shape;
  std::optional<OpticalConstants> index;
};

}  // namespace dolp
