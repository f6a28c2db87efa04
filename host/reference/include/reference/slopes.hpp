#pragma once

#include <cmath>
#include <optional>

#include "model/choices.hpp"

namespace dolp::reference {

class Slopes {
 public:
  /// Domain: sigma > 0; cauchy q > 1.
  Slopes(Distribution distribution, double sigma, double q);

  /// D(alpha) in 1/sr. Equation: (8) for the cauchy, (1) for the gaussian, of Wang, Li, Wang 2025.
  double facet_density(double tan2_alpha) const;

  /// p(t), the density of the slopes t = tan(gamma) in one vertical plane.
  double in_plane_density(double slope) const;

  /// Share of the slopes in one vertical plane that exceed `slope`. Domain: slope >= 1e8 m(), where p is a power law.
  double in_plane_tail(double slope) const;

  /// Share of all facets that are steeper than t, at any azimuth.
  double share_above(double t) const;

  double quantile(double share) const;

  /// Mean slope due to slopes above t. Domain: cauchy q > 3/2; t >= 1e8 m(), where the density is a power law.
  double length_above(double t) const;

  /// Integrals over slopes use the variable v, with t = at(v) = width() sinh(v). density_at(v) is the density of v.
  double at(double v) const { return width_ * std::sinh(v); }
  double slope_coordinate(double t) const { return std::asinh(t / width_); }
  double density_at(double v) const;

  /// Slope beyond which the densities fall off. It is the natural unit of t.
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

/// A zenith angle. Formulas for directions near the horizon use the elevation, in which no digits cancel.
struct Zenith {
  double elevation_rad = 0.0;
  double cos = 1.0;  ///< cosine of the zenith angle
  double sin = 0.0;
};

/// Lambda of Smith's height-correlated masking, in closed form. Domain: cos(zenith) > 0; cauchy q > 3/2.
double smith_lambda(const Slopes& slopes, const Zenith& zenith);

/// G_1 of the masking `integral` for a facet of tilt alpha, toward the zenith theta. Accuracy: `tolerance`, absolute.
/// Equation: t = tan(gamma) is a slope in one vertical plane, and p is the density of these slopes. G_1 is the share of
/// slopes with gamma < a, plus int p (1 + cos(theta + gamma)/cos(theta - alpha)) dt for gamma from a to b. Here
/// a = pi/2 - theta and b = min(pi/2, pi - 2 theta + alpha). Source: Wang, Li, Wang 2025, eqs. (9)-(12).
class IntegralMasking {
 public:
  IntegralMasking(const Slopes& slopes, const Zenith& zenith, double tolerance);
  double operator()(double alpha_rad) const;

 private:
  const Slopes& slopes_;
  Zenith zenith_;
  double tolerance_;
  double slope_a_;      ///< tan(a), see the equation
  double share_below_;  ///< share of slopes with gamma < a
};

class Attenuation {
 public:
  Attenuation(const Slopes& slopes, Masking masking, const Zenith& a, const Zenith& b, double tolerance);
  double operator()(double tan2_alpha, double cos2_beta) const;

 private:
  Masking masking_;
  double v_cavity_;  ///< (cos a + cos b) min(cos a, cos b) for the zeniths a, b; G = min(1, v_cavity_ / cos^2(beta))
  double smith_ = 1.0;
  std::optional<IntegralMasking> integral_;
};

}  // namespace dolp::reference
