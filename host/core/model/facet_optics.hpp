#pragma once

#include <compare>
#include <cstddef>
#include <memory>
#include <vector>

namespace dolp {

/// Complex refractive index n + ik. The time factor is e^(-i omega t), so k >= 0.
struct OpticalConstants {
  double n = 1.0;
  double k = 0.0;
  friend auto operator<=>(const OpticalConstants&, const OpticalConstants&) = default;
};

struct Film {
  OpticalConstants index;
  double thickness = 0.0;  ///< in vacuum wavelengths
  double spread = 0.0;     ///< standard deviation of the thickness over the surface, in vacuum wavelengths
  friend auto operator<=>(const Film&, const Film&) = default;
};

/// Measured reflectances R_s and R_p of a smooth surface at one wavelength. Between measured angles they are linear in
/// the angle beta. Between the first two angles only R_s + R_p is linear; R_s - R_p is proportional to sin^2(beta), but
/// at most so large that R_s and R_p are in [0, 1].
struct MeasuredReflectance {
  std::vector<double> beta_deg;  ///< angles of incidence, ascending from 0 to 90; r_s and r_p are equal at 0
  std::vector<double> r_s;
  std::vector<double> r_p;

  std::size_t row_above(double angle_deg) const;  ///< the first row beyond the angle; the last row if there is none
};

/// Absorptances of a smooth surface, s = 1 - R_s and p = 1 - R_p.
struct SmoothAbsorptance {
  double s = 1.0;
  double p = 1.0;
  double error = 0.0;  ///< bound of the rounding errors of s and p that is not relative to them; 0 for a bare medium
  double split = 0.0;  ///< (R_s - R_p) / sin^2(angle of incidence)
};

/// The material of a facet: a bare medium, a medium under films, or a surface with measured reflectances.
struct FacetOptics {
  OpticalConstants index;   ///< n and k of the medium
  std::vector<Film> films;  ///< from the outside in; they interfere
  std::shared_ptr<const MeasuredReflectance> measured;

  FacetOptics() = default;
  FacetOptics(const OpticalConstants& medium) : index(medium) {}  // NOLINT: a bare medium is one
  FacetOptics(double n, double k) : index{n, k} {}
  bool is_bare() const { return films.empty() && !measured; }
  friend auto operator<=>(const FacetOptics&, const FacetOptics&) = default;
  friend bool operator==(const FacetOptics&, const FacetOptics&) = default;
};

}  // namespace dolp
