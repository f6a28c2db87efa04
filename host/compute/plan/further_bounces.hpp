// Contribution of the bounces after the first to the pBRDF of V-grooves, in double.
#pragma once

#include "model/scattering.hpp"

namespace dolp {

/// Adds the beams of two and more bounces to f cos(theta_i) cos(theta_r) of the first.
///
/// Equation: the light that leaves after k bounces comes from the grooves whose horizontal direction u lies along h,
/// the horizontal part of omega_i + omega_r, or against it, and whose gamma = pi/2 - alpha is
/// (pi - psi_i - psi_r)/(2 k) for odd k, (pi - psi_i + psi_r)/(2 k) for even k, psi being the angle from z toward u
/// across the groove;
///   f^(k) cos(theta_i) cos(theta_r) = D sin(alpha) a ds_k M / (2 k |h|),
/// a ds_k being the width of the beam of k bounces and M their Mueller matrix (shaders/physics/README.md, section 3).
/// Domain: masking v-cavity. NaN where h = 0, where the beams mirror each other: there grooves of all azimuths reflect.
/// Accuracy: `accuracy` of m00, and where more than 1,000 bounces count, next to |psi_i| = |psi_r| of strong
/// reflectors, what may be left, in `error`.
/// Returns the bounces computed, which are its cost.
int add_further_bounces(ScatteringMatrix& f, const ScatteringRequest& request, const ScatteringEntry& entry,
                        double accuracy);

}  // namespace dolp
