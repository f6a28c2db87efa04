// Diffuse reflection of a scene's surface at one index.
#pragma once

#include <Eigen/Core>

#include "model/facet_optics.hpp"
#include "model/sky_basis.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// Diffusely reflected light for unpolarised incident light, in the frame of the view: Q > 0 is s-polarised.
struct DiffuseLight {
  double i = 0.0;
  double q = 0.0;
};

/// The diffuse part of a pBRDF.
///
/// Equation: f = k_d / pi (cos theta_i cos theta_r)^c, times t(theta_r) t(theta_i)^T / t_+(0)^2 with
/// diffuse_polarisation "transmission": t = (t_+, t_-, 0, 0), t_+- = (T_s +- T_p) / 2 of the smooth surface. Light
/// enters the body, loses its polarisation there and leaves. Source: Baek, Jeon, Tong, Kim 2018, Simultaneous
/// acquisition of polarimetric SVBRDF and normals, section 4. Domain: a bare medium.
class DiffuseReflection {
 public:
  DiffuseReflection(const Surface& surface, const FacetOptics& optics);

  /// The diffuse part of rho. By reciprocity it also holds for uniform incident light. Domain: cosine in [0, 1].
  DiffuseLight rho(double cosine) const;
  /// pi cos(theta_i) f.
  DiffuseLight beam(double cos_theta_i, double cos_theta_r) const;
  /// (t_+, t_-) at a direction, each divided by t_+(0); (1, 0) for unpolarised reflection.
  DiffuseLight transmitted(double cosine) const;
  /// Weights of a sky's values at nodes. Their sum is the mean radiance that this reflection receives.
  Eigen::VectorXd mean_weights(const SkyNodes& nodes) const;

 private:
  double albedo_;
  double exponent_;
  bool is_polarised_;
  FacetOptics optics_;
  double normal_ = 1.0;    ///< t_+(0)
  double integral_ = 0.0;  ///< integral of mu^(c + 1) t_+(mu) / t_+(0) over mu from 0 to 1
};

/// True if the diffuse part of rho has no limit at 90 degrees.
bool diffuse_diverges(const Surface& surface);

}  // namespace dolp
