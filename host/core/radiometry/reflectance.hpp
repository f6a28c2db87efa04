#pragma once

#include <span>

#include "model/moments.hpp"
#include "radiometry/diffuse.hpp"
#include "scene/scene.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {

struct Reflectance {
  double rho_i = 0.0;
  double rho_q = 0.0;
  double rho_u = 0.0;
  double absorbed = 0.0;  ///< 1 - rho_i, computed without cancellation
  double rho_i_error = 0.0;
  double rho_q_error = 0.0;
  double rho_u_error = 0.0;  ///< 0 if U is 0 by symmetry
  double absorbed_error = 0.0;
  double mismatch = 0.0;  ///< |rho_i + absorbed - 1|; not exactly 0, because separate sums give rho_i and absorbed
};

/// Polarised emissivity at one index: i + q for s polarisation, i - q for p polarisation.
struct Emissivity {
  double i = 0.0;
  double q = 0.0;
  double u = 0.0;
  double i_error = 0.0;
  double q_error = 0.0;
  double u_error = 0.0;
  double terms = 0.0;  ///< sum of the magnitudes of the terms of i; rounding errors are relative to it
};

struct MeanReflectance {
  double rho_i = 0.0;
  double rho_q = 0.0;
  double rho_u = 0.0;
  double error = 0.0;  ///< error of rho_i, rho_q or rho_u, whichever is largest
};

Reflectance reflectance(const Surface& surface, const Moments& moments, double cos_theta, const DiffuseLight& diffuse);

/// True if rho_s or rho_p is outside [0, 1] by more than its error.
bool is_unphysical(const Reflectance& r);

/// The light with which a sample counts in the mean of a reflectance or an emissivity.
enum class MeanLight { kEmitted, kIncident, kWidth };

/// The emitted light; if there is none, the incident light; if there is neither, the sample width.
MeanLight mean_light(const SpectralRule& rule, double cos_theta);
double mean_weight(const SpectralSample& sample, MeanLight light, double cos_theta);

/// Mean of rho over the samples, with mean_light().
MeanReflectance mean_reflectance(const SpectralRule& rule, std::span<const Reflectance> reflectances, double cos_theta);

Emissivity fresnel_emissivity(const FacetOptics& index, double cos_theta);

/// Emissivity of the diffuse part, and of the light that facets emit straight to the viewer.
/// Equation: eps_I = k_s direct_i / cos(theta) + 1 - k_s - diffuse.i and eps_Q = k_s direct_q / cos(theta) - diffuse.q,
/// where direct_i and direct_q are members of Moments, and k_s is Surface::specular.
Emissivity direct_emissivity(const Surface& surface, const Moments& moments, double cos_theta,
                             const DiffuseLight& diffuse);

Emissivity kirchhoff_emissivity(const Reflectance& r);

}  // namespace dolp
