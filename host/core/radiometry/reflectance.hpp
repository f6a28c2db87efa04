#pragma once

#include <boost/container/small_vector.hpp>
#include <cmath>

#include "model/moments.hpp"
#include "radiometry/diffuse.hpp"
#include "scene/scene.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {

/// One element per spectral sample. Most scenes have one sample, whose element needs no allocation.
template <class Element>
using PerSample = boost::container::small_vector<Element, 1>;

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

/// sqrt(Q^2 + U^2). U is 0 in most scenes, by symmetry.
inline double polarised_part(double q, double u) { return u == 0.0 ? std::abs(q) : std::hypot(q, u); }

Reflectance reflectance(const Surface& surface, const Moments& moments, double cos_theta, const DiffuseLight& diffuse);

/// True if rho_s or rho_p is outside [0, 1] by more than its error.
bool is_unphysical(const Reflectance& r);

/// Weights of the spectral samples in the mean of a reflectance or an emissivity: the emitted light; if there is none,
/// the incident light; if there is neither, the width of the sample.
struct MeanWeights {
  PerSample<double> list;
  double total = 0.0;
  double diffuse = 0.0;  ///< what DiffuseSpectrum adds to the sum of the weights times rho_i
};
MeanWeights mean_weights(const SpectralRule& rule, double cos_theta);

MeanReflectance mean_reflectance(const SpectralRule& rule, const PerSample<Reflectance>& reflectances,
                                 const MeanWeights& weights);

Emissivity fresnel_emissivity(const FacetOptics& index, double cos_theta);

/// Emissivity of the diffuse part, and of the light that facets emit straight to the viewer.
/// Equation: eps_I = k_s direct_i / cos(theta) + 1 - k_s - diffuse.i and eps_Q = k_s direct_q / cos(theta) - diffuse.q,
/// where direct_i and direct_q are members of Moments, and k_s is Surface::specular.
Emissivity direct_emissivity(const Surface& surface, const Moments& moments, double cos_theta,
                             const DiffuseLight& diffuse);

Emissivity kirchhoff_emissivity(const Reflectance& r);

}  // namespace dolp
