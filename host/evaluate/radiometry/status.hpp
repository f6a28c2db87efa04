// The bits of the `status` variable; this is the only place that numbers them.
#pragma once

#include <cstdint>

namespace dolp {

/// rho_s or rho_p outside [0, 1] by more than its error bound: Kirchhoff's law does not hold there.
inline constexpr std::uint32_t kStatusUnphysicalReflectance = 1;
/// The scene's tolerance is not met, for rho or for DOLP.
inline constexpr std::uint32_t kStatusToleranceMissed = 2;
/// Outside the model's domain; what cannot be given is NaN.
inline constexpr std::uint32_t kStatusOutsideDomain = 4;
/// I <= 0: the sum of what is emitted and reflected is not a radiation that exists.
inline constexpr std::uint32_t kStatusNonPositiveIntensity = 8;

/// Without one of these the tolerance is promised for DOLP, or its error said.
inline constexpr std::uint32_t kStatusNoDolpPromised =
    kStatusUnphysicalReflectance | kStatusOutsideDomain | kStatusNonPositiveIntensity;

}  // namespace dolp
