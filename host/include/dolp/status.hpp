// Status bits of an entry or point; 0 means that nothing is wrong. Only this file numbers them.
#pragma once

#include <array>
#include <cstdint>

namespace dolp {

enum Status : std::uint32_t {
  kReflectanceOutsideZeroToOne = 1,  ///< rho_s or rho_p is outside [0, 1] by more than its error bound
  kToleranceNotMet = 2,              ///< DOLP misses the scene's tolerance
  kOutsideModelDomain = 4,           ///< the entry is outside the model's domain; undefined quantities are NaN
  kIntensityNotPositive = 8,         ///< I <= 0: such radiation does not exist
  kRhoToleranceNotMet = 16,          ///< rho misses the scene's tolerance; DOLP may still meet it
  /// The estimated error of I is above 5 % of I, or that of DOLP above 5 % of DOLP and above 0.001, because single
  /// scattering loses light or a masking function creates light. If no other bit is set, the numbers are right for the
  /// model, but the model is wrong for the surface.
  kModelInaccurate = 32,
};

/// If the estimated error of I or of DOLP is above this fraction of I or DOLP, the status gets the bit
/// kModelInaccurate.
inline constexpr double kLargestModelChange = 0.05;
/// Smaller errors of DOLP (0.1 points) never set the bit kModelInaccurate, even if DOLP is nearly 0.
inline constexpr double kLeastModelChangeDolp = 1e-3;

struct StatusBit {
  std::uint32_t mask;
  const char* meaning;
};

/// The status bits in the order in which table files describe them.
inline constexpr std::array<StatusBit, 6> kStatusBits = {{
    {kReflectanceOutsideZeroToOne, "reflectance_outside_zero_to_one"},
    {kToleranceNotMet, "tolerance_not_met"},
    {kOutsideModelDomain, "outside_model_domain"},
    {kIntensityNotPositive, "intensity_not_positive"},
    {kRhoToleranceNotMet, "rho_tolerance_not_met"},
    {kModelInaccurate, "model_inaccurate"},
}};

inline constexpr std::uint32_t kAnyToleranceNotMet = kToleranceNotMet | kRhoToleranceNotMet;

/// If the status has any of these bits, the accuracy of the DOLP is unknown.
inline constexpr std::uint32_t kNoDolpPromised =
    kReflectanceOutsideZeroToOne | kOutsideModelDomain | kIntensityNotPositive;

/// True if the accuracy of the DOLP is known: it meets the tolerance, unless the status has the bit kToleranceNotMet.
inline bool promises_dolp(std::uint32_t status) { return (status & kNoDolpPromised) == 0; }

}  // namespace dolp
