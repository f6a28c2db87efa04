// Fresnel reflection of the reference, in complex amplitudes.
#pragma once

#include <complex>

#include "model/facet_optics.hpp"

namespace dolp::reference {

/// Amplitude coefficients and absorptances, without cancellation.
struct FresnelCoefficients {
  std::complex<double> r_s;
  std::complex<double> r_p;
  double absorbed_s = 0.0;  ///< 1 - |r_s|^2
  double absorbed_p = 0.0;  ///< 1 - |r_p|^2
};

/// Reflection at the angle beta from the facet normal.
/// Conventions: r_p = -r_s at normal incidence.
FresnelCoefficients fresnel(const FacetOptics& optics, double cos_beta);

}  // namespace dolp::reference
