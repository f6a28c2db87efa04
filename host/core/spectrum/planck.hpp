#pragma once

namespace dolp {

/// Equation: B = (2 h c^2 / lambda^5) / (exp(h c / (lambda k_B T)) - 1), with the exact SI constants.
/// Units: wavelength in um, temperature in K, result in W m-2 sr-1 um-1.
/// Domain: wavelength > 0, temperature >= 0. The result is 0 at 0 K, and where it would be below the range of double.
/// Accuracy: 4 + h c / (lambda k_B T) units in the last place (test Planck_FiftyDigitValues_Agree).
double planck_radiance(double wavelength_um, double temperature_K);

}  // namespace dolp
