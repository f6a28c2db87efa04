#pragma once

#include <limits>
#include <numbers>

namespace dolp {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kDoubleRoundoff = 0x1p-53;
inline constexpr double kFloatRoundoff = 0x1p-24;
inline constexpr double kRootPi = 1.0 / std::numbers::inv_sqrtpi;

}  // namespace dolp
