#pragma once

#include <cstddef>
#include <vector>

namespace dolp {

inline constexpr int kDispersionFormulas = 9;

/// A refractive index n as a function of wavelength: one of nine formulas, with the coefficients C1, C2, …
/// Source: M. Polyanskiy, "Dispersion formulas", in the refractiveindex.info database, which numbers the formulas.
/// Accuracy: reproduces published indices to their last digit (test Dispersion_Formulas_*).
struct Dispersion {
  int number = 0;                    ///< number of the formula, 1 to kDispersionFormulas; 0 means no formula
  std::vector<double> coefficients;  ///< C1, C2, …; coefficient_counts() says how many are allowed

  double at(double wavelength_um) const;  ///< n; NaN if the formula gives a negative n^2
};

/// The numbers of coefficients that a formula may have. Coefficients missing at the end are zero.
std::vector<std::size_t> coefficient_counts(int number);

}  // namespace dolp
