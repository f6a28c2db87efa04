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
/// Equation: the true eps_I is eps_I,direct + d with an unknown d, 0 <= d <= D = 1 - rho_I - eps_I,direct; eps_Q
/// changes by at most d. Let X be the exitance of source and surroundings, and N = pi B - X. Then I = X + N eps_I and Q
/// = N eps_Q. DOLP has its extreme values at d = D: (|sum N eps_Q,direct| -+ sum |N| D) / I. Under a sky they may also
/// be at d = 0.
struct Bracket {
  double low = 0.0;
  double high = 0.0;
  double error = 0.0;  ///< bound of the absolute errors of low and high
};

/// Sums emission, reflected surroundings and, if `with_source`, reflected light of the source.
Stokes stokes_sum(const SpectralRule& rule, std::span<const Reflectance> reflectances,
                  std::span<const Emissivity> emissivities, EmissionModel model, double cos_theta, bool with_source);

/// Adds net * r_i to I and net * r_q to Q. Like the moments, `sum` has the factor cos(theta).
void add_specular(Stokes& sum, double net, const Moments& moments);

/// The diffuse part in a spectral sample. `beyond_mean`: mean sky exitance that it receives, minus the sky's mean.
struct DiffuseSample {
  DiffuseLight rho;
  double beyond_mean = 0.0;
};

/// Adds the reflected light of a sky, minus that of a uniform sky with the same mean. `weights` is empty without a sky.
/// Its specular part is k_s / cos(theta) times the weighted sum of the moments with sky functions. Its diffuse part is
/// DiffuseSample::rho times beyond_mean.
void add_sky(Stokes& sum, const Surface& surface, const SpectralRule& rule, std::span<const SkyWeights> weights,
             std::span<const DiffuseSample> diffuse, std::span<const Moments> moments, double cos_theta);

/// Adds the specular part of add_sky: `specular` times the weighted sum of the moments with the functions of the sky.
void add_specular_sky(Stokes& sum, double specular, double rounding, const SkyWeights& weights, const Moments& moments);

/// Adds the source's reflected light as an exitance, pi E0 cos(theta_i) f. `diffuse`: pi cos(theta_i) f_diffuse.
void add_beam(Stokes& sum, double k_s, const SpectralRule& rule, std::span<const Scattered> scattered,
              std::span<const DiffuseLight> diffuse, double cos_theta_r);

/// Multiplies the Stokes parameters by the transmittance of the path, then adds the path's exitance to I.
void add_path(Stokes& sum, const std::optional<Path>& path, double path_exitance);

/// `direct`: emissivities of the direct emission. `sky`: Stokes parameters that add_sky adds.
Bracket bracket(const SceneModel& scene, const SpectralRule& rule, std::span<const Reflectance> reflectances,
                std::span<const Emissivity> direct, const Stokes& sky, double cos_theta);

double relative_bound(double error, double value);

}  // namespace dolp
