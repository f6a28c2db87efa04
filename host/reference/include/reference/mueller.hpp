#pragma once

#include <Eigen/Core>

#include "model/choices.hpp"
#include "model/scattering.hpp"
#include "reference/slopes.hpp"

namespace dolp::reference {

/// The specular pBRDF f_s times cos(theta_i) cos(theta_r), without the factor k_s. Units: sr^-1.
/// Conventions: Delta_phi = 180 degrees is the specular side. A beam along k has s = k x z and p = k x s; at zenith 0,
/// s is the limit at the azimuth of the beam. Q = I_s - I_p, U = 2 Re(E_s* E_p), V = 2 Im(E_s* E_p).
using Mueller = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

/// Light that bounces once. The Jones matrix is computed in quadruple precision from the s and p vectors of the beams
/// and of the facet. Equation: (4), (7), (15) of Wang, Li, Wang 2025.
/// Domain: zeniths in [0, 90] degrees, but not both 90; sigma > 0; an elliptic distribution needs masking none or
/// v-cavity. Accuracy: 1e-12 of element m00.
Mueller single_bounce(const Slopes& slopes, Masking masking, const FacetOptics& constants, const BeamAngles& angles);

/// Light that bounces k = `bounces` times in V-grooves.
/// Equation: D(alpha) sin(alpha) F_k M / (2 k |h|), summed over two kinds of grooves.
/// - h is the horizontal part of omega_i + omega_r.
/// - u is the horizontal unit vector across the groove. In one kind of grooves u is along h, in the other against h.
/// - psi_i and psi_r are the angles of omega_i and omega_r from z toward u, in the plane across the groove.
/// - alpha is the tilt of the facets: 2 k (90 degrees - alpha) = 180 degrees - psi_i + (-1)^k psi_r.
/// - F_k is the flux of a beam that leaves a groove after k bounces, for facets of length 1.
/// - M is the Mueller matrix of the k bounces, from electric vectors that are followed through the bounces.
/// Domain: masking v-cavity. NaN in the mirror direction, where h = 0.
Mueller light_of_bounces(const Slopes& slopes, const FacetOptics& constants, const BeamAngles& angles, int bounces);

/// Sum of light_of_bounces() over k. `error` is 0 unless theta_i is so close to theta_r that 2000 bounces are too few.
struct BouncesSum {
  Mueller matrix = Mueller::Zero();
  double error = 0.0;
};
BouncesSum all_bounces(const Slopes& slopes, const FacetOptics& constants, const BeamAngles& angles);

}  // namespace dolp::reference
