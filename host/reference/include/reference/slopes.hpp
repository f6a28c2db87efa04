#pragma once

#include <cmath>
#include <optional>

#include "model/choices.hpp"
#include "model/slopes.hpp"

namespace dolp::reference {

/// Weights of a facet at azimuth phi from the viewer and of its mirror image at -phi.
struct MirrorWeights {
  double mean = 1.0;
  double half_difference = 0.0;
};

/// A slope distribution. An elliptic one is the isotropic distribution of its larger width, times weights that depend
/// on the azimuth. Functions without an azimuth are those of the isotropic distribution.
class Slopes {
 public:
  /// Domain: sigma > 0; cauchy q > 1.
  Slopes(Distribution distribution, const SlopeShape& shape);

  /// Weight of a facet whose normal is tilted toward the azimuth phi, counter-clockwise from the viewer; 1 if
  /// isotropic. Equation: P(t_x, t_y) = C g(t_x^2 / m^2 + t_y^2 / m_c^2), with the isotropic density C g(t^2 / m^2).
  /// The slope t_x is along the x axis, which is at SlopeShape::azimuth_deg.
  double weight(double tan2_alpha, double cos_phi, double sin_phi) const;
  MirrorWeights mirror_weights(double tan2_alpha, double cos_phi, double sin_phi) const;

  /// Mean weight of the facets that are steeper than t.
  double weight_above(double t) const;

  /// The isotropic distribution with the same slopes in the vertical plane of the viewer. It decides the smith masking.
  Slopes in_view_plane() const;

  /// Azimuth, in [0, pi/2] from the viewer or its opposite direction, of the axis with the larger width; 0 if
  /// isotropic.
  double ridge_rad() const { return ridge_rad_; }

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
  // An elliptic distribution. The narrow axis is the axis with the smaller width.
  double elongation_ = 1.0;  ///< larger width over smaller width
  double excess_ = 0.0;      ///< 1 / m^2 along the narrow axis, minus 1 / m^2 along the other axis
  double narrow_cos_ = 0.0;  ///< cosine of the azimuth of the narrow axis from the viewer
  double narrow_sin_ = 1.0;
  double ridge_rad_ = 0.0;
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
