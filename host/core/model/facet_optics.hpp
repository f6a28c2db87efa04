// Optics of a facet at one wavelength.
#pragma once

#include <compare>
#include <complex>
#include <memory>
#include <vector>

#include "model/optical_constants.hpp"

namespace dolp {

/// A film of a coating, at one wavelength.
struct Film {
  OpticalConstants index;
  double thickness = 0.0;  ///< in vacuum wavelengths
  friend auto operator<=>(const Film&, const Film&) = default;
};

/// Measured reflectances of a smooth surface, at one wavelength: straight lines between angles. Up to the second angle
/// R_s - R_p goes as sin^2(beta).
struct MeasuredReflectance {
  std::vector<double> beta_deg;  ///< ascending, from 0 to 90; both reflectances agree at 0
  std::vector<double> r_s;
  std::vector<double> r_p;
};

/// A medium, bare or under films, or measured reflectances instead of both.
struct FacetOptics {
  OpticalConstants index;   ///< of the medium
  std::vector<Film> films;  ///< from the outside in; they interfere
  std::shared_ptr<const MeasuredReflectance> measured;

  FacetOptics() = default;
  FacetOptics(const OpticalConstants& medium) : index(medium) {}  // NOLINT: a bare medium is one
  FacetOptics(double n, double k) : index{n, k} {}
  bool is_bare() const { return films.empty() && !measured; }
  friend auto operator<=>(const FacetOptics&, const FacetOptics&) = default;
  friend bool operator==(const FacetOptics&, const FacetOptics&) = default;
};

/// Amplitudes that a facet reflects.
struct ReflectedAmplitudes {
  std::complex<double> s;
  std::complex<double> p;
};

/// Amplitudes of a medium under films.
///
/// Equation: the recursion r = (r_j + r e^(2 i delta)) / (1 + r_j r e^(2 i delta)) from the medium outward,
/// delta = 2 pi d q / lambda, q = sqrt(N^2 - sin^2 beta).
/// Source: Born and Wolf, Principles of Optics, section 1.6. Conventions: r_p = -r_s at normal incidence.
/// Domain: cosine in (0, 1].
ReflectedAmplitudes film_amplitudes(const FacetOptics& optics, double cosine);

/// Fringes that the films add between grazing and normal incidence: periods of e^(2 i delta).
double fringe_count(const FacetOptics& optics);

}  // namespace dolp
