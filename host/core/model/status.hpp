// The bits of the `status` variable; this is the only place that numbers them.
#pragma once

#include <array>
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

/// In the order in which files list them, with a word for each.
struct StatusBit {
  std::uint32_t mask;
  const char* meaning;
};
inline constexpr std::array<StatusBit, 4> kStatusBits = {{
    {kStatusUnphysicalReflectance, "reflectance_outside_zero_to_one"},
    {kStatusToleranceMissed, "tolerance_not_met"},
    {kStatusOutsideDomain, "outside_model_domain"},
    {kStatusNonPositiveIntensity, "intensity_not_positive"},
}};

/// With any of these nothing is promised of the DOLP.
inline constexpr std::uint32_t kStatusNoDolpPromised =
    kStatusUnphysicalReflectance | kStatusOutsideDomain | kStatusNonPositiveIntensity;

/// Whether the tolerance, or else kStatusToleranceMissed, is promised for the DOLP.
inline bool promises_dolp(std::uint32_t status) { return (status & kStatusNoDolpPromised) == 0; }

}  // namespace dolp
