// The dispersion formulas of refractiveindex.info.
#pragma once

#include <cstddef>
#include <vector>

namespace dolp {

inline constexpr int kDispersionFormulas = 9;

/// A refractive index as a formula of wavelength with coefficients C1, C2, …
///
/// Source: M. Polyanskiy, "Dispersion formulas", the document of the refractiveindex.info database, which numbers them.
/// Accuracy: published indices to their last digit (test Dispersion_Formulas_*).
struct Dispersion {
  int number = 0;                    ///< 1 to kDispersionFormulas; 0 is none
  std::vector<double> coefficients;  ///< as many as coefficient_counts allows

  /// n at a wavelength; NaN where n^2 would be negative.
  double at(double wavelength_um) const;
};

/// Numbers of coefficients that a formula may have. Terms left out at the end are zero.
std::vector<std::size_t> coefficient_counts(int number);

}  // namespace dolp
