// The 16 elements of the specular Mueller pBRDF, from explicit vectors.
#pragma once

#include <array>

#include "scene/scene.hpp"

namespace dolp {

using MuellerMatrix = std::array<std::array<double, 4>, 4>;

/// f_s with k_s = 1, its Jones matrix built from the s and p vectors of the beams and of the facet: no angle eta.
/// Equation: (4), (7), (15).
/// Units: sr^-1.
/// Conventions: Delta_phi = 180 degrees is the specular side; s = k x z, p = k x s for both beams;
///   Q = I_s - I_p, U = 2 Re(E_s* E_p), V = 2 Im(E_s* E_p).
/// Domain: 0 < theta < 90 degrees for both; sigma > 0; not the retro direction.
MuellerMatrix reference_pbrdf(const Surface& surface, const OpticalConstants& constants, double theta_i_deg,
                              double theta_r_deg, double delta_phi_deg);

}  // namespace dolp
