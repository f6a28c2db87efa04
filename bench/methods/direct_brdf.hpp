// The plain textbook formulas of the model, for the methods that dolp is compared with. They share nothing with the
// shaders or the reference. They are programmed as a user who cares about time would do it: reflectances in real
// arithmetic, and `integral` masking from tables of three integrals. A moment belongs to one beam with a fixed
// direction. It is an integral over the directions of the other beam, which these files call the running beam.
#pragma once

#include <cstddef>
#include <memory>

#include "model/moments.hpp"

namespace dolp::bench {

/// One entry of a request.
struct Entry {
  Distribution distribution = Distribution::kCauchy;
  Masking masking = Masking::kIntegral;
  double theta_rad = 0.0;
  SlopeShape shape;
  OpticalConstants index;
};
Entry entry_of(const MomentsRequest& request, std::size_t position);

/// Two elements of the Mueller matrix M of a facet, times the masking G: `i` is G M00, `q` is G M01.
struct Reflected {
  double i = 0.0;
  double q = 0.0;
};

/// Tables of integrals over the in-plane slope density, from a given slope to infinity. `smith` and `integral` masking
/// are computed from these integrals.
class MaskingTails;

/// A direction of the running beam, with the part of the masking G that does not depend on the facet.
struct RunningBeam {
  double cos = 1.0;
  double sin = 0.0;
  /// For smith masking, G. For integral masking, MaskingTails::height of the beam nearer to the horizon. Else unused.
  double masking = 0.0;
};

/// The microfacet surface seen from one fixed direction.
///
/// Equation: (1), (2), (3), (5), (7), (8), (9)-(12) of the paper that shaders/physics/README.md names.
/// Accuracy: moments agree with the reference to 1e-7 (test BenchFormulas).
/// Domain: 0 < theta < 90 degrees, sigma > 0, cauchy q > 1 (smith: q > 3/2).
class DirectSurface {
 public:
  /// How to compute Lambda of Smith's masking. The closed form is faster for a few directions of the running beam, the
  /// table for many.
  enum class SmithBy { kClosedForm, kTable };
  DirectSurface(const Entry& entry, SmithBy smith_by);
  DirectSurface(const DirectSurface&) = delete;
  DirectSurface& operator=(const DirectSurface&) = delete;
  ~DirectSurface();

  double cos_theta() const { return cos_theta_; }
  double sin_theta() const { return sin_theta_; }
  /// Width m of the slope distribution, m^2 = 2 sigma^2.
  double width() const { return m_; }

  /// Density P(t) = D cos^4(alpha) of the slopes t = tan(alpha), per unit area of the plane of slopes. Units: 1.
  double slope_density(double tan2_alpha) const;

  /// The slope that a facet exceeds with this probability, in (0, 1], if it is drawn from the density D cos(alpha).
  double sampled_slope(double probability) const;

  /// The running beam in the direction with cosine cos_r > 0 and sine sin_r, with its part of the masking G.
  RunningBeam beam(double cos_r, double sin_r) const;

  /// Masking G times M00 and M01 of the facet that reflects one beam into the other. M01 is 0 if the facet or the
  /// surface has no plane of incidence.
  Reflected reflected(const RunningBeam& beam, double cos_alpha, double tan_alpha, double cos_beta) const;

 private:
  double smith_lambda(double mu) const;
  double attenuation(const RunningBeam& beam, double cos_alpha, double tan_alpha, double cos_beta) const;

  Entry entry_;
  double cos_theta_;
  double sin_theta_;
  double m_;
  std::unique_ptr<MaskingTails> tails_;
  /// Part of the masking G that belongs to the fixed beam: Lambda (smith) or MaskingTails::height (integral).
  double fixed_masking_ = 0.0;
};

/// Integrand of the moments at one direction of the running beam.
/// Equation: r = int_0^{pi/2} dtheta_r int_0^pi d(delta_phi) D G M sin(theta_r)/2. The azimuth covers half a circle;
/// the integrand is doubled to count the other half.
Reflected beam_integrand(const DirectSurface& surface, const RunningBeam& beam, double cos_azimuth);

/// Integrand of the moments as a function of the facet: its slope t = tan_alpha, and its azimuth phi_h from the fixed
/// beam. The factor P(t) t dt dphi_h is left out. Zero if the reflected ray does not leave the surface.
/// Equation: r = int P t dt dphi_h (cos(beta)/cos(alpha)) G M, over cos(theta_r) > 0.
Reflected half_vector_integrand(const DirectSurface& surface, double tan_alpha, double cos_phi);

}  // namespace dolp::bench
