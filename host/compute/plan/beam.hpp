#pragma once

#include <vector>

#include "model/scattering.hpp"
#include "plan/kernel_data.hpp"

namespace dolp {

struct BeamGeometry {
  kernel::GeometryNode node{};
  double sin2_beta = 0.0;
};

/// The facet that reflects one beam into the other. The mirror direction has delta_phi = 180 degrees. eta_i and eta_r
/// are the angles from the s vector of each beam to the s vector of the facet (shaders/physics/mueller.glsl). A
/// positive angle turns s toward p. The angles have the sign of sin(delta_phi), and are 0 in the retro direction. If
/// theta_i is 0, the plane of incidence has azimuth 0. If theta_r is 0, the plane of reflection has azimuth delta_phi.
/// Domain: zeniths from 0 to 90 degrees, but not both 90.
BeamGeometry beam_geometry(double theta_i_deg, double theta_r_deg, double delta_phi_deg);

/// Inputs of the kernel for one entry. The kernel's result is the pBRDF times cos(theta_i) cos(theta_r) / 2^power. The
/// division by 2^power is needed because a float cannot hold very small slope densities.
struct Beam {
  kernel::BeamNode node{};
  int power = 0;
};

/// Makes the beams of a request. The request must outlive the object. The host computes the geometry, the slope density
/// and the reflection of the facet, because a float would lose too many digits in some directions.
class BeamPlan {
 public:
  explicit BeamPlan(const ScatteringRequest& request);
  Beam operator()(const ScatteringEntry& entry) const;

  /// The ScatteringMatrix of all bounces. `unit_roundoff` is the roundoff of the kernel's precision.
  ScatteringMatrix matrix(const kernel::MuellerNode& node, const Beam& beam, const ScatteringEntry& entry,
                          double unit_roundoff) const;

  /// The kernel data without beams: the model and the rule nodes.
  const KernelData& data() const { return data_; }

 private:
  const ScatteringRequest& request_;
  KernelData data_;
  std::vector<BeamGeometry> geometries_;
};

/// Adds the light after two and more bounces to `f`, the pBRDF of the first bounce times cos(theta_i) cos(theta_r).
/// Returns the number of computed bounces, a measure of the time. Equation: shaders/physics/README.md, section 3.
/// Domain: masking v-cavity. In the mirror direction, grooves of all azimuths contribute, and the result is NaN.
/// Accuracy: relative error `accuracy` of the added m00. If a strong reflector needs more than kMostBouncesOfBeam
/// bounces, f.error includes a bound of the light that they may add.
int add_further_bounces(ScatteringMatrix& f, const ScatteringRequest& request, const ScatteringEntry& entry,
                        double accuracy);

/// ln(D / 4) at a slope. D is the density of the facet normals, and the pBRDF contains D / 4.
double log_density(Distribution distribution, const SlopeShape& shape, double slope);

}  // namespace dolp
