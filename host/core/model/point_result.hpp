#pragma once

#include <cstdint>
#include <limits>

namespace dolp {

/// Everything the program reports about one entry of a grid or one scattered point.
///
/// Units: Stokes parameters are exitances, W m-2 um-1 at a single wavelength and W m-2 over a band; in bistatic mode
/// radiances, W m-2 sr-1 um-1 and W m-2 sr-1; the others are 1.
/// Conventions: Q = I_s - I_p keeps its sign; U = V = 0 in hemispherical mode. Over a band rho is the mean weighted by
/// the emission pi B(T), without emission by the incident radiation, without either by the wavelength.
struct PointResult {
  double dolp = 0.0;  ///< sqrt(Q^2 + U^2) / I; negative with a negative I, NaN with I = 0
  double stokes_i = 0.0;
  double stokes_q = 0.0;
  double stokes_u = 0.0;
  double stokes_v = 0.0;
  double rho_i = 0.0;           ///< with k_s and the diffuse part
  double rho_q = 0.0;           ///< with k_s
  double albedo = 0.0;          ///< A(theta): R = 1, without k_s and the diffuse part
  double error_estimate = 0.0;  ///< bound of |d DOLP|, dolp_low and dolp_high included; infinite when there is none
  /// What the emission uses, over a band weighted with pi B(T); NaN without emission.
  double emissivity_s = std::numeric_limits<double>::quiet_NaN();
  double emissivity_p = std::numeric_limits<double>::quiet_NaN();
  /// Between what DOLP lies of a surface with these facets and all its bounces; NaN where it was not asked for.
  double dolp_low = std::numeric_limits<double>::quiet_NaN();
  double dolp_high = std::numeric_limits<double>::quiet_NaN();
  double rho_error_estimate = 0.0;  ///< bound of max(|d rho_I|, |d rho_Q|) / rho_I; infinite when there is none
  std::uint32_t status = 0;         ///< bits of status.hpp
};

}  // namespace dolp
