// Geometric attenuation ("masking") of the reference.
#pragma once

#include <optional>

#include "reference/slopes.hpp"

namespace dolp::reference {

/// A zenith angle and its elevation above the horizon. With both, nothing cancels at grazing incidence.
struct Zenith {
  double elevation_rad = 0.0;
  double cos = 1.0;  ///< cosine of the zenith angle
  double sin = 0.0;  ///< sine of the zenith angle
};

/// Lambda of the height-correlated Smith masking, in closed form.
/// Domain: cos(zenith) > 0; cauchy q > 3/2.
double smith_lambda(const Slopes& slopes, const Zenith& zenith);

/// G_1 of the paper's masking, by direct numerical integration over the in-plane tilt gamma.
/// Equation: G_1 = P(gamma < a) + int_a^b p (1 + cos(theta + gamma)/cos(theta - alpha)), a = pi/2 - theta,
///   b = min(pi/2, pi - 2 theta + alpha). Source: eqs. (9)-(12).
/// Accuracy: `tolerance`, absolute.
class IntegralMasking {
 public:
  /// Fixes the zenith angle. Integrates the terms that do not depend on alpha.
  IntegralMasking(const Slopes& slopes, const Zenith& zenith, double tolerance);
  double operator()(double alpha_rad) const;

 private:
  const Slopes& slopes_;
  Zenith zenith_;
  double tolerance_;
  double slope_a_;      ///< tan a
  double share_below_;  ///< P(gamma < a)
};

/// G for one pair of zenith angles, as a function of the facet.
class Attenuation {
 public:
  Attenuation(const Slopes& slopes, Masking masking, const Zenith& a, const Zenith& b, double tolerance);
  double operator()(double tan2_alpha, double cos2_beta) const;

 private:
  Masking masking_;
  double v_cavity_;  ///< (cos a + cos b) min(cos a, cos b); G needs it over cos^2 beta
  double smith_ = 1.0;
  std::optional<IntegralMasking> integral_;
};

}  // namespace dolp::reference
