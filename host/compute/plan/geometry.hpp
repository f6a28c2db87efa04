#pragma once

#include "plan/kernel_data.hpp"

namespace dolp {

/// The facet between two beams.
struct BeamGeometry {
  kernel::GeometryNode node{};
  double sin2_beta = 0.0;
};

/// The facet between two beams, and the rotation angles of eq. (4), in double and without cancellation.
///
/// Equation: eqs. (2)-(6) as |w_i + w_r|^2 = 4 cos^2(beta), |w_i - w_r|^2 = 4 sin^2(beta), and eta_i as the direction
/// of (sin i cos r - cos i sin r cos(dphi), sin r sin(dphi)), eta_r likewise with i and r exchanged in the first.
/// Conventions: delta_phi = 180 degrees is the specular side; eta turns s toward p and has the sign of
/// sin(delta_phi).
/// Domain: zeniths in [0, 90] degrees, not 90 both. In the retro direction, where eta is undefined, the limit
/// eta_i = eta_r = 0; at theta_i = 0 the plane of incidence is that of azimuth 0, at theta_r = 0 that of delta_phi.
BeamGeometry beam_geometry(double theta_i_deg, double theta_r_deg, double delta_phi_deg);

}  // namespace dolp
