// The plain textbook formulas of the model, for the methods that dolp is compared with.
//
// Nothing here is shared with the shaders or with the reference. Reflectances are in real arithmetic and the masking of
// the paper comes from tables of its three primitives, because a user who cares about time would do so too.
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

/// G M00 and G M01: the reflection of one facet.
struct Reflected {
  double i = 0.0;
  double q = 0.0;
};

/// Tails of the in-plane slope density, from which both tabulated maskings follow.
class MaskingTails;

/// The direction of the running beam, with the part of G that depends on nothing else.
struct RunningBeam {
  double cos = 1.0;
  double sin = 0.0;
  double masking = 0.0;  ///< smith: G; integral: height integral of the lower of the two beams; unused otherwise
};

/// The microfacet surface seen from one fixed direction.
///
/// Equation: (1), (2), (3), (5), (7), (8), (9)-(12).
/// Accuracy: tables of the masking 1e-10 absolute (test BenchFormulas).
/// Domain: 0 < theta < 90 degrees, sigma > 0, cauchy q > 1 (smith: q > 3/2).
class DirectSurface {
 public:
  /// The source of Smith's Lambda: the closed form is best for a few running beams, the table for many.
  enum class SmithBy { kClosedForm, kTable };
  DirectSurface(const Entry& entry, SmithBy smith_by);
  DirectSurface(const DirectSurface&) = delete;
  DirectSurface& operator=(const DirectSurface&) = delete;
  ~DirectSurface();

  double cos_theta() const { return cos_theta_; }
  double sin_theta() const { return sin_theta_; }
  /// Width m of the slope distribution, m^2 = 2 sigma^2.
  double width() const { return m_; }

  /// P(t), t = tan(alpha): density of slopes over their plane, D cos^4(alpha). Units: 1.
  double slope_density(double tan2_alpha) const;

  /// Slope whose exceedance probability under D cos(alpha) is `probability` in (0, 1].
  double sampled_slope(double probability) const;

  /// Prepares G for a running beam; cos_r > 0.
  RunningBeam beam(double cos_r, double sin_r) const;

  /// G M00 and G M01 of the facet between the fixed beam and the running one; 0 for M01 where eta is undefined.
  Reflected reflected(const RunningBeam& beam, double cos_alpha, double tan_alpha, double cos_beta) const;

 private:
  double smith_lambda(double mu) const;
  double attenuation(const RunningBeam& beam, double cos_alpha, double tan_alpha, double cos_beta) const;

  Entry entry_;
  double cos_theta_;
  double sin_theta_;
  double m_;
  std::unique_ptr<MaskingTails> tails_;
  double fixed_masking_ = 0.0;  ///< smith: Lambda; integral: height integral, of the fixed beam
};

/// The integrand over the running beam, by the plain formulas.
/// Equation: r = int_0^{pi/2} dtheta_r int_0^pi d(delta_phi) D G M sin(theta_r)/2, both halves of the azimuth counted.
Reflected beam_integrand(const DirectSurface& surface, const RunningBeam& beam, double cos_azimuth);

/// The facet of slope tan_alpha at azimuth phi_h from the fixed beam: whether its ray leaves, and what it reflects per
/// unit of P(t) t dt dphi_h.
/// Equation: r = int P t dt dphi_h (cos(beta)/cos(alpha)) G M, over cos(theta_r) > 0.
Reflected half_vector_integrand(const DirectSurface& surface, double tan_alpha, double cos_phi);

}  // namespace dolp::bench
