#pragma once

#include <dolp/key.hpp>
#include <limits>

namespace dolp {

inline constexpr NumberRange kZenithDegRange{0.0, 90.0};
inline constexpr NumberRange kAzimuthDegRange{-360.0, 360.0};
inline constexpr NumberRange kSigmaRange{0.0, 10.0};
inline constexpr NumberRange kSigmaCrossRange{0.0, 10.0, NumberRange::Ends::kOpenBelow};
inline constexpr NumberRange kWindRange{0.0, 100.0};
inline constexpr NumberRange kQRange{1.0, 1e4, NumberRange::Ends::kOpenBelow};
inline constexpr NumberRange kNRange{0.0, 1e6, NumberRange::Ends::kOpenBelow};
inline constexpr NumberRange kKRange{0.0, 1e6};
inline constexpr NumberRange kThicknessUmRange{0.0, 1000.0};
inline constexpr NumberRange kFractionRange{0.0, 1.0};
inline constexpr NumberRange kDiffuseExponentRange{-1.0, 0.0, NumberRange::Ends::kOpenBelow};
inline constexpr NumberRange kEmissionTemperatureRange{0.0, 1e4, NumberRange::Ends::kOpenBelow};
inline constexpr NumberRange kBackgroundTemperatureRange{0.0, 1e4};
inline constexpr NumberRange kVapourRange{0.0, 10.0};
inline constexpr NumberRange kAirTemperatureRange{180.0, 330.0};
inline constexpr NumberRange kNonNegativeRange{0.0, std::numeric_limits<double>::infinity()};
inline constexpr NumberRange kPositiveRange{0.0, std::numeric_limits<double>::infinity(),
                                            NumberRange::Ends::kOpenBelow};
inline constexpr NumberRange kResponseRange{0.0, 1e100};
inline constexpr NumberRange kWavelengthUmRange{0.1, 1e4};
/// If all wavelengths in um are above this number, they are probably in nm.
inline constexpr double kLikelyNanometres = 1000.0;
/// A temperature below this number is probably in degrees Celsius instead of K, because few surfaces are so cold.
inline constexpr double kLikelyCelsius_K = 60.0;
/// If all zeniths in degrees are below this number, they are probably in radians.
inline constexpr double kLikelyRadians = 1.6;
inline constexpr NumberRange kToleranceRange{1e-10, 1e-2};
inline constexpr NumberRange kAxisCountRange{1.0, 1e6};
inline constexpr NumberRange kLabelRange{0.0, 1e6};  ///< positions in the list of labels (names) of an axis

/// Range of q for smith masking with the cauchy distribution. Smith masking uses the mean slope, which is infinite if q
/// is 3/2 or less (shaders/physics/README.md, section 2).
inline constexpr NumberRange kSmithCauchyQRange{1.5, 1e4, NumberRange::Ends::kOpenBelow};

}  // namespace dolp
