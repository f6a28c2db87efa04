#pragma once

#include <Eigen/Core>

#include "model/facet_optics.hpp"
#include "model/sky_basis.hpp"
#include "model/transmission.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// Diffusely reflected light if the incident light is unpolarised. Q > 0 means s-polarised with respect to the view.
struct DiffuseLight {
  double i = 0.0;
  double q = 0.0;
  double error = 0.0;  ///< bound of the errors of i and q, beyond rounding errors
};

/// The diffuse part of a pBRDF.
/// Equation: f = k_d / pi (cos theta_i cos theta_r)^c with the scene's k_d and c. With diffuse_polarisation
/// "transmission" the light enters the body, loses its polarisation there and leaves. Then f also has the factor
/// t(theta_r) t(theta_i)^T / t_+(0)^2. The vector t = (t_+, t_-, 0, 0) consists of t_+ = (T_s + T_p) / 2 and
/// t_- = (T_s - T_p) / 2, with the transmittances T_s and T_p of the smooth surface.
/// Source: Baek, Jeon, Tong, Kim 2018, Simultaneous acquisition of polarimetric SVBRDF and normals, section 4.
/// Domain: a bare medium.
class DiffuseReflection {
 public:
  DiffuseReflection(const Surface& surface, const FacetOptics& optics,
                    TransmissionIntegral transmission = transmission_integral);

  /// Reflectance into the direction `cosine` under uniform light. By reciprocity, `i` is also the reflectance for light
  /// that comes from this direction. Domain: cosine in [0, 1].
  DiffuseLight rho(double cosine) const;
  /// The diffuse pBRDF times pi cos(theta_i).
  DiffuseLight beam(double cos_theta_i, double cos_theta_r) const;
  /// t_+ and t_- of the class comment, at the incidence `cosine`, over t_+(0). 1 and 0 if is_polarised_ is false.
  DiffuseLight transmitted(double cosine) const;
  /// Mean of a function of the sky, weighted with the light that the diffuse part reflects. `sky`: values at the nodes.
  Estimate sky_mean(const SkyNodes& nodes, const Eigen::VectorXd& sky) const;

 private:
  double albedo_;
  double exponent_;
  bool is_polarised_;
  FacetOptics optics_;
  TransmissionIntegral transmission_;
  double normal_ = 1.0;  ///< t_+(0)
  Estimate integral_;    ///< integral of mu^(exponent_ + 1) t_+ over the cosine mu from 0 to 1
};

/// True if the diffuse part of rho has no limit at 90 degrees.
bool diffuse_diverges(const Surface& surface);

}  // namespace dolp
