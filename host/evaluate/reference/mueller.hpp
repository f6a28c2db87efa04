// The 16 elements of the specular Mueller pBRDF, from explicit vectors.
#pragma once

#include <array>

#include "scene/scene.hpp"

namespace dolp {

using MuellerMatrix = std::array<std::array<double, 4>, 4>;

/// f_s cos(theta_i) cos(theta_r) with k_s = 1, its Jones matrix built from the s and p vectors of the beams and of the
/// facet in quadruple precision: no angle eta, no care for cancellation.
/// Equation: (4), (7), (15).
/// Units: sr^-1.
/// Conventions: Delta_phi = 180 degrees is the specular side; s = k x z, p = k x s for both beams, at zenith 0 the
/// limit
///   at the beam's azimuth; Q = I_s - I_p, U = 2 Re(E_s* E_p), V = 2 Im(E_s* E_p).
/// Domain: zeniths in [0, 90] degrees, not 90 both; sigma > 0.
/// Accuracy: 1e-12 of m00.
MuellerMatrix reference_scattering(const Surface& surface, const OpticalConstants& constants, double theta_i_deg,
                                   double theta_r_deg, double delta_phi_deg);

/// The same without the cosines: f_s. Domain: zeniths below 90 degrees.
MuellerMatrix reference_pbrdf(const Surface& surface, const OpticalConstants& constants, double theta_i_deg,
                              double theta_r_deg, double delta_phi_deg);

}  // namespace dolp
