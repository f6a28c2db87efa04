#pragma once

#include <optional>
#include <span>

#include "model/choices.hpp"
#include "model/moments.hpp"
#include "model/scattering.hpp"
#include "radiometry/reflectance.hpp"
#include "scene/scene.hpp"
#include "spectrum/sky_factors.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {

/// Stokes parameters summed over the spectral samples, with bounds of their errors.
struct Stokes {
  double i = 0.0;
  double q = 0.0;
  double i_error = 0.0;
  double q_error = 0.0;
  double u = 0.0;
  double v = 0.0;
  double u_error = 0.0;
};

/// Lower and upper bound of the DOLP that the surface has with all bounces.
/// Equation: later bounces add an unknown d to the direct emissivity eps_I,direct, with 0 <= d <= D and
/// D = 1 - rho_I - eps_I,direct. They change eps_Q,direct by at most d. With the exitance X of source and surroundings
/// and N = pi B - X, the surface has I = X + N eps_I and Q = N eps_Q. DOLP has its extreme values at d = D,
/// (|sum of N eps_Q,direct| -+ sum of |N| D) / I, or under a sky profile at d = 0. Sums are over the samples.
struct Bracket {
  double low = 0.0;
  double high = 0.0;
  double error = 0.0;  ///< bound of the absolute errors of low and high
};

/// Sums emission, reflected surroundings and, if `with_source`, reflected light of the source.
Stokes stokes_sum(const SpectralRule& rule, std::span<const Reflectance> reflectances,
                  std::span<const Emissivity> emissivities, EmissionModel model, double cos_theta, bool with_source);

/// Adds net * r_i to I and net * r_q to Q. Moments have the factor cos(theta), so `sum` has it too.
void add_specular(Stokes& sum, double net, const Moments& moments);

/// The diffuse part in a spectral sample. `beyond_mean`: sky exitance averaged with mean_weights(), minus its mean.
struct DiffuseSample {
  DiffuseLight rho;
  double beyond_mean = 0.0;
};

/// Adds the light that a surface reflects from a sky, minus what it would reflect from a uniform sky with the same
/// mean. The specular part is k_s / cos(theta) times the weighted sum of Moments::columns. The diffuse part is
/// DiffuseSample::rho times beyond_mean. `weights`: weights of the functions of the sky; empty without a sky.
void add_sky(Stokes& sum, const Surface& surface, const SpectralRule& rule, std::span<const SkyWeights> weights,
             std::span<const DiffuseSample> diffuse, std::span<const Moments> moments, double cos_theta);

/// Adds the specular part of add_sky: `specular` times the weighted sum of Moments::columns.
void add_specular_sky(Stokes& sum, double specular, double rounding, const SkyWeights& weights, const Moments& moments);

/// Adds the light of the source as an exitance, pi E0 cos(theta_i) f. `diffuse`: pi cos(theta_i) f of the diffuse part.
void add_beam(Stokes& sum, double k_s, const SpectralRule& rule, std::span<const Scattered> scattered,
              std::span<const DiffuseLight> diffuse, double cos_theta_r);

/// Multiplies the Stokes parameters by the transmittance of the path, then adds the path's exitance to I.
void add_path(Stokes& sum, const std::optional<Path>& path, double path_exitance);

Bracket bracket(const SceneModel& scene, const SpectralRule& rule, std::span<const Reflectance> reflectances,
                std::span<const Emissivity> direct, const Stokes& sky, double cos_theta);

double relative_bound(double error, double value);

}  // namespace dolp
