#pragma once

#include <compare>

namespace dolp {

/// Complex refractive index n + ik; time factor e^(-i omega t), so k >= 0.
struct OpticalConstants {
  double n = 1.0;
  double k = 0.0;
  friend auto operator<=>(const OpticalConstants&, const OpticalConstants&) = default;
};

}  // namespace dolp
