#pragma once

#include <vector>

#include "model/scattering.hpp"
#include "plan/kernel_data.hpp"

namespace dolp {

struct BeamGeometry {
  kernel::GeometryNode node{};
  double sin2_beta = 0.0;
};

/// The facet between two beams, and the angles eta of eq. (4) of the paper, in double and without cancellation.
///
/// Equation: eqs. (2)-(6) in the form |omega_i + omega_r|^2 = 4 cos^2(beta), |omega_i - omega_r|^2 = 4 sin^2(beta).
/// With i = theta_i and r = theta_r, eta_i is the angle of the vector (sin i cos r - cos i sin r cos(dphi), sin r
/// sin(dphi)), and eta_r the angle of (sin r cos i - cos r sin i cos(dphi), sin i sin(dphi)). Conventions: delta_phi =
/// 180 degrees is the specular side; eta turns s toward p and has the sign of sin(delta_phi). Domain: zeniths from 0 to
/// 90 degrees, but not both 90. In the retro direction eta is undefined; the result is the limit eta_i = eta_r = 0. At
/// theta_i = 0 the plane of incidence has azimuth 0; at theta_r = 0 it has azimuth delta_phi.
BeamGeometry beam_geometry(double theta_i_deg, double theta_r_deg, double delta_phi_deg);

/// Inputs of the kernel for one entry. The pBRDF is the kernel's result times 2^power.
struct Beam {
  kernel::BeamNode node{};
  int power = 0;
};

/// Makes the beams of a request, which must outlive the object. operator() is a pure function.
///
/// The host computes the geometry, D and the reflection of the facet, because their rounding in a float would exceed
/// 1e-5 of m00 near the normal, the retro direction and the critical angle, and far down the slope distribution. The
/// kernel gets D over 2^Beam::power, so that no float over- or underflows.
class BeamPlan {
 public:
  explicit BeamPlan(const ScatteringRequest& request);
  Beam operator()(const ScatteringEntry& entry) const;

  /// The pBRDF of all bounces, with its error bound. `unit_roundoff` is the roundoff of the kernel's precision.
  ScatteringMatrix matrix(const kernel::MuellerNode& node, const Beam& beam, const ScatteringEntry& entry,
                          double unit_roundoff) const;

  /// The kernel data without beams: the model and the rule nodes.
  const KernelData& data() const { return data_; }

 private:
  const ScatteringRequest& request_;
  KernelData data_;
  std::vector<BeamGeometry> geometries_;
};

/// Adds the beams of two and more bounces to `f`, which holds f cos(theta_i) cos(theta_r) of the first bounce.
///
/// Equation: Let h be the horizontal part of omega_i + omega_r. Light that leaves after k bounces comes from grooves
/// whose horizontal direction u points along h or against it. Their gamma = pi/2 - alpha is (pi - psi_i - psi_r)/(2 k)
/// for odd k and (pi - psi_i + psi_r)/(2 k) for even k. psi_i and psi_r are the zeniths of the two beams in the plane
/// across the groove, positive toward u. Then
///   f^(k) cos(theta_i) cos(theta_r) = D sin(alpha) a ds_k M / (2 k |h|),
/// where a ds_k is the width of the beam of k bounces, and M its Mueller matrix (shaders/physics/README.md, section 3).
/// Domain: masking v-cavity. At h = 0, the mirror direction, grooves of all azimuths contribute, and the result is NaN.
/// Accuracy: relative error `accuracy` of the added m00. Next to |psi_i| = |psi_r|, more than kMostBouncesOfBeam
/// bounces of a strong reflector may count; f.error then includes a bound of the light that they may add.
/// Returns the number of computed bounces, a measure of the time.
int add_further_bounces(ScatteringMatrix& f, const ScatteringRequest& request, const ScatteringEntry& entry,
                        double accuracy);

/// ln(D / 4), with the density D of the facet normals, at a slope.
double log_density(Distribution distribution, const SlopeShape& shape, double slope);

}  // namespace dolp
