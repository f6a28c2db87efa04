#pragma once

#include <cmath>
#include <optional>

#include "model/choices.hpp"

namespace dolp::reference {

class Slopes {
 public:
  /// Domain: sigma > 0; cauchy q > 1.
  Slopes(Distribution distribution, double sigma, double q);

  /// D(alpha) in 1/sr. Equation: (8) for the cauchy, (1) for the gaussian.
  double facet_density(double tan2_alpha) const;

  /// p(t), the density of the slope t = tan(gamma) in one vertical plane.
  double in_plane_density(double slope) const;

  /// Share of the in-plane slopes above `slope`. Domain: slope >= 1e8 m, where p equals its leading power.
  double in_plane_tail(double slope) const;

  /// Share of all facets with slopes above t, at any azimuth.
  double share_above(double t) const;

  double quantile(double share) const;

  /// int 2 pi P t^2 dt over all slopes above t. Domain: cauchy q > 3/2; t >= 1e8 m, where P equals its leading power.
  double length_above(double t) const;

  /// t = width sinh(v), and its inverse. density_at() is 2 pi P t dt/dv, whose integral over v is 1.
  double at(double v) const { return width_ * std::sinh(v); }
  double coordinate_of(double t) const { return std::asinh(t / width_); }
  double density_at(double v) const;

  /// Slope at which the densities fall off: the natural unit of t.
  double width() const { return width_; }
  double m() const { return m_; }
  double q() const { return q_; }
  bool is_gaussian() const { return distribution_ == Distribution::kGaussian; }

 private:
  Distribution distribution_;
  double m_;
  double q_;
  double width_;
  double in_plane_norm_;  ///< p(0)
};

/// With both angles nothing cancels at grazing incidence.
struct Zenith {
  double elevation_rad = 0.0;
  double cos = 1.0;  ///< cosine of the zenith angle
  double sin = 0.0;
};

/// Lambda of the height-correlated masking, in closed form. Domain: cos(zenith) > 0; cauchy q > 3/2.
double smith_lambda(const Slopes& slopes, const Zenith& zenith);

/// G_1 of the paper's masking, by direct numerical integration over the in-plane tilt gamma.
/// Equation: G_1 = P(gamma < a) + int_a^b p (1 + cos(theta + gamma)/cos(theta - alpha)), a = pi/2 - theta, b =
/// min(pi/2, pi - 2 theta + alpha). Source: eqs. (9)-(12). Accuracy: `tolerance`, absolute.
class IntegralMasking {
 public:
  /// Integrates the terms that do not depend on alpha.
  IntegralMasking(const Slopes& slopes, const Zenith& zenith, double tolerance);
  double operator()(double alpha_rad) const;

 private:
  const Slopes& slopes_;
  Zenith zenith_;
  double tolerance_;
  double slope_a_;      ///< tan a
  double share_below_;  ///< P(gamma < a)
};

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
