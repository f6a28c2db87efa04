// The model in plain textbook formulas, for the methods that the benchmark compares with dolp. This code shares nothing
// with the shaders or the reference. It is written for speed: it computes reflectances without complex numbers, and
// `integral` masking from tables. A moment is an integral over the directions of one beam, called the running beam. The
// other beam, called the fixed beam, keeps its direction.
#pragma once

#include <cstddef>
#include <memory>

#include "model/moments.hpp"

namespace dolp::bench {

/// One entry of a MomentsRequest.
struct Entry {
  Distribution distribution = Distribution::kCauchy;
  Masking masking = Masking::kIntegral;
  double theta_rad = 0.0;
  SlopeShape shape;
  OpticalConstants index;
};
Entry entry_of(const MomentsRequest& request, std::size_t position);

/// Contribution of a facet to the moments: its masking G, times the elements M00 (`i`) and M01 (`q`) of its Mueller
/// matrix M.
struct Reflected {
  double i = 0.0;
  double q = 0.0;
};

/// Tables of integrals over slopes, from which `smith` and `integral` masking are computed.
class MaskingTails;

/// A direction of the running beam, with a value from which the masking G of each facet is computed.
struct RunningBeam {
  double cos = 1.0;
  double sin = 0.0;
  /// For `smith` it is G. For `integral` it is the tabulated function MaskingTails::height at cot(theta) of the beam
  /// with the larger zenith angle theta. For other maskings it is unused.
  double masking = 0.0;
};

/// The microfacet surface seen from one fixed direction.
///
/// Equations: (1)-(3), (5) and (7)-(12) of the paper that shaders/physics/README.md names.
/// Accuracy: moments without total reflection agree with the reference to 1e-7 (test BenchFormulas).
/// Domain: 0 < theta < 90 degrees, sigma > 0. Cauchy slopes need q > 1, or q > 3/2 with `smith`.
class DirectSurface {
 public:
  /// How to compute the function Lambda of Smith's masking. The closed form is faster for few running beams. A table
  /// takes time to make, and is then faster for many running beams.
  enum class SmithBy { kClosedForm, kTable };
  DirectSurface(const Entry& entry, SmithBy smith_by);
  DirectSurface(const DirectSurface&) = delete;
  DirectSurface& operator=(const DirectSurface&) = delete;
  ~DirectSurface();

  double cos_theta() const { return cos_theta_; }
  double sin_theta() const { return sin_theta_; }
  /// Width m of the slope distribution, m^2 = 2 sigma^2.
  double width() const { return m_; }

  /// Joint density P of the two slope components, at the slope tan(alpha). P is D cos^4(alpha), where D is the density
  /// of facet normals.
  double slope_density(double tan2_alpha) const;

  /// The slope that a random facet exceeds with this probability. The facet normals have the density D cos(alpha).
  double sampled_slope(double probability) const;

  /// The running beam with the zenith angle whose cosine is cos_r > 0 and whose sine is sin_r.
  RunningBeam beam(double cos_r, double sin_r) const;

  /// Contribution of the facet that reflects the running beam into the fixed beam. `q` is 0 if the fixed beam is normal
  /// to the facet or to the surface, because the plane of incidence or the vertical plane is then undefined.
  Reflected reflected(const RunningBeam& beam, double cos_alpha, double tan_alpha, double cos_beta) const;

 private:
  double smith_lambda(double mu) const;
  double attenuation(const RunningBeam& beam, double cos_alpha, double tan_alpha, double cos_beta) const;

  Entry entry_;
  double cos_theta_;
  double sin_theta_;
  double m_;
  std::unique_ptr<MaskingTails> tails_;
  /// A number of the fixed beam that the masking needs: Lambda for `smith`, MaskingTails::height for `integral`.
  double fixed_masking_ = 0.0;
};

/// Integrand of the moments over the directions (theta_r, delta_phi) of the running beam:
///   r = int_0^{pi/2} dtheta_r int_0^pi d(delta_phi) D G M sin(theta_r)/2
/// D is the density of facet normals, G the masking and M the element M00 or M01. Only azimuths delta_phi from 0 to pi
/// are integrated: the integrand is doubled, because both halves contribute equally.
Reflected beam_integrand(const DirectSurface& surface, const RunningBeam& beam, double cos_azimuth);

/// Integrand of the moments over the facets, for the Monte Carlo method:
///   r = int P t dt dphi_h (cos(beta)/cos(alpha)) G M, where P is slope_density()
/// Returns (cos(beta)/cos(alpha)) G M, without P, for the facet with slope t = tan_alpha and azimuth phi_h from the
/// fixed beam; cos_phi is cos(phi_h). Returns 0 if the facet reflects below the horizon.
Reflected half_vector_integrand(const DirectSurface& surface, double tan_alpha, double cos_phi);

}  // namespace dolp::bench
