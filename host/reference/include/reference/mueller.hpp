#pragma once

#include <array>

#include "scene/scene.hpp"

namespace dolp {

using ReferenceMueller = std::array<std::array<double, 4>, 4>;

/// f_s cos(theta_i) cos(theta_r) with k_s = 1. The Jones matrix is computed in quadruple precision from the s and p
/// vectors of the beams and of the facet. Equation: (4), (7), (15) of Wang, Li, Wang 2025; for kMultiple, the sum of
/// reference_all_bounces. Units: sr^-1.
/// Conventions: Delta_phi = 180 degrees is the specular side. Each beam has s = k x z and p = k x s. At zenith 0, s is
/// the limit for the beam's azimuth. Q = I_s - I_p, U = 2 Re(E_s* E_p), V = 2 Im(E_s* E_p).
/// Domain: zeniths in [0, 90] degrees, but not both 90; sigma > 0. Accuracy: 1e-12 of element m00.
ReferenceMueller reference_scattering(const Surface& surface, const FacetOptics& constants, double theta_i_deg,
                                      double theta_r_deg, double delta_phi_deg);

/// The part of the pBRDF, times both cosines, of light that bounces k = `bounces` times in V-grooves.
/// Equation: f^(k) cos(theta_i) cos(theta_r) = D sin(alpha) cos(alpha) w_k M / (2 k |h|), with the facet density D and
/// the tilt alpha of the facets. It is summed over both facets that the light may meet first.
/// - h is the horizontal part of omega_i + omega_r, and u is the unit vector along h or against h.
/// - psi_i and psi_r are the angles of omega_i and omega_r from z toward u, in the plane across the groove.
/// - gamma = 90 degrees - alpha is (180 - psi_i - psi_r)/(2 k) for odd k, (180 - psi_i + psi_r)/(2 k) for even k.
/// - w_k cos(alpha) is the flux that leaves a groove after k bounces.
/// - M is the Mueller matrix of the electric vectors, which are followed through the bounces.
/// Domain: masking v-cavity. NaN in the mirror direction, where h = 0.
ReferenceMueller reference_bounces(const Surface& surface, const FacetOptics& constants, double theta_i_deg,
                                   double theta_r_deg, double delta_phi_deg, int bounces);

/// Sum of reference_bounces. Its error is 0 unless theta_i is close to theta_r: there many bounces contribute.
struct BouncesSum {
  ReferenceMueller matrix{};
  double error = 0.0;
};
BouncesSum reference_all_bounces(const Surface& surface, const FacetOptics& constants, double theta_i_deg,
                                 double theta_r_deg, double delta_phi_deg);

/// f_s, that is reference_scattering divided by both cosines. Domain: zeniths below 90 degrees.
ReferenceMueller reference_pbrdf(const Surface& surface, const FacetOptics& constants, double theta_i_deg,
                                 double theta_r_deg, double delta_phi_deg);

}  // namespace dolp
