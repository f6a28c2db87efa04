#pragma once

namespace dolp {

struct CosSin {
  double cos = 1.0;
  double sin = 0.0;
};

CosSin cos_sin_deg(double angle_deg);  ///< cosine and sine of an angle in degrees, exact at multiples of 90 degrees

}  // namespace dolp
