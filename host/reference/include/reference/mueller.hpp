#pragma once

#include <array>

#include "model/scattering.hpp"
#include "reference/slopes.hpp"
#include "scene/scene.hpp"

namespace dolp {

using ReferenceMueller = std::array<std::array<double, 4>, 4>;

/// The specular pBRDF f_s times cos(theta_i) cos(theta_r), without the factor k_s. Units: sr^-1. The Jones matrix is
/// computed in quadruple precision from the s and p vectors of the beams and of the facet.
/// Equation: (4), (7), (15) of Wang, Li, Wang 2025. For Scattering::kMultiple the result is reference_all_bounces().
/// Conventions: Delta_phi = 180 degrees is the specular side. A beam along k has s = k x z and p = k x s; at zenith 0,
/// s is the limit at the azimuth of the beam. Q = I_s - I_p, U = 2 Re(E_s* E_p), V = 2 Im(E_s* E_p).
/// Domain: zeniths in [0, 90] degrees, but not both 90; sigma > 0. Accuracy: 1e-12 of element m00.
ReferenceMueller reference_scattering(const Surface& surface, const FacetOptics& constants, double theta_i_deg,
                                      double theta_r_deg, double delta_phi_deg);

/// The pBRDF f^(k) of light that bounces k = `bounces` times in V-grooves, times cos(theta_i) cos(theta_r).
/// Equation: D(alpha) sin(alpha) F_k M / (2 k |h|), summed over two kinds of grooves.
/// - h is the horizontal part of omega_i + omega_r.
/// - u is the horizontal unit vector across the groove. In one kind of grooves u is along h, in the other against h.
/// - psi_i and psi_r are the angles of omega_i and omega_r from z toward u, in the plane across the groove.
/// - alpha is the tilt of the facets: 2 k (90 degrees - alpha) = 180 degrees - psi_i + (-1)^k psi_r.
/// - F_k is the flux of a beam that leaves a groove after k bounces, for facets of length 1.
/// - M is the Mueller matrix of the k bounces, from electric vectors that are followed through the bounces.
/// Domain: masking v-cavity. NaN in the mirror direction, where h = 0.
ReferenceMueller reference_bounces(const Surface& surface, const FacetOptics& constants, double theta_i_deg,
                                   double theta_r_deg, double delta_phi_deg, int bounces);

/// Sum of reference_bounces() over k. `error` is 0 unless theta_i is so close to theta_r that 2000 bounces are too few.
struct BouncesSum {
  ReferenceMueller matrix{};
  double error = 0.0;
};
BouncesSum reference_all_bounces(const Surface& surface, const FacetOptics& constants, double theta_i_deg,
                                 double theta_r_deg, double delta_phi_deg);
BouncesSum reference_all_bounces(const reference::Slopes& slopes, const FacetOptics& constants,
                                 const BeamAngles& angles);

/// reference_scattering() with single scattering. Domain: an elliptic distribution needs masking none or v-cavity.
ReferenceMueller reference_single_bounce(const reference::Slopes& slopes, Masking masking, const FacetOptics& constants,
                                         const BeamAngles& angles);

/// f_s: reference_scattering() divided by both cosines. Domain: zeniths below 90 degrees.
ReferenceMueller reference_pbrdf(const Surface& surface, const FacetOptics& constants, double theta_i_deg,
                                 double theta_r_deg, double delta_phi_deg);

}  // namespace dolp
