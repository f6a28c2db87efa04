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
/// Equation: the true eps_I is the direct eps_I + d with an unknown d, 0 <= d <= D = 1 - rho_I - eps_I,direct; eps_Q
/// changes by at most d. Let X be the exitance of source and surroundings, and N = pi B - X. Then I = X + N eps_I and Q
/// = N eps_Q. DOLP has its extreme values at d = D, where I is that of single scattering: (|sum N eps_Q,direct| -+ sum
/// |N| D) / I.
/// Under a sky, X is the middle of the range of the sky's exitance, and M is half of this range. The reflection of the
/// sky's difference from X is computed with single scattering. The light D - d of later bounces comes from an unknown
/// part of the sky; it changes Q and I by at most M (D - d). So the extreme values may also be at d = 0.
struct Bracket {
  double low = 0.0;
  double high = 0.0;
  double error = 0.0;  ///< bound of the absolute errors of low and high
};

/// Sums emission, reflected surroundings and, if `with_source`, the source's light reflected into the hemisphere.
Stokes stokes_sum(const SpectralRule& rule, std::span<const Reflectance> reflectances,
                  std::span<const Emissivity> emissivities, EmissionModel model, double cos_theta, bool with_source);

/// Adds net * r_i to I and net * r_q to Q, so that `sum` has the factor cos(theta) of the moments.
void add_specular(Stokes& sum, double net, const Moments& moments);

/// The diffuse part in a spectral sample. `beyond_mean`: mean sky exitance that it receives, minus the plain mean.
struct DiffuseSample {
  DiffuseLight rho;
  double beyond_mean = 0.0;
};

/// Adds the reflected light of a sky, minus that of a uniform sky with the same mean. `weights` is empty without a sky.
/// Equation: in I and in Q, pi (S - mean(L) rho) = k_s / cos(theta) sum_k w_k r_k + pi rho_diffuse (mean_diffuse(L) -
/// mean(L)). L is the radiance of the sky, S the reflected radiance, r_k the moment with sky function k, and w_k the
/// weight of this function in pi (L - mean(L)) of the sample.
void add_sky(Stokes& sum, const Surface& surface, const SpectralRule& rule, std::span<const SkyWeights> weights,
             std::span<const DiffuseSample> diffuse, std::span<const Moments> moments, double cos_theta);

/// Adds the specular part of add_sky: `specular` times the weighted sum of the moments with the functions of the sky.
void add_specular_sky(Stokes& sum, double specular, double rounding, const SkyWeights& weights, const Moments& moments);

/// Adds the source's reflected beam as an exitance, pi E0 cos(theta_i) f. `diffuse`: pi cos(theta_i) f, diffuse part.
void add_beam(Stokes& sum, double k_s, const SpectralRule& rule, std::span<const Scattered> scattered,
              std::span<const DiffuseLight> diffuse, double cos_theta_r);

/// Multiplies the Stokes parameters by the transmittance of the path, then adds the path's exitance to I.
void add_path(Stokes& sum, const std::optional<Path>& path, double path_exitance);

/// `direct`: emissivities of the direct emission. `sky`: Stokes parameters that add_sky adds.
Bracket bracket(const SceneModel& scene, const SpectralRule& rule, std::span<const Reflectance> reflectances,
                std::span<const Emissivity> direct, const Stokes& sky, double cos_theta);

/// Bound of the relative error of `value`, which has an absolute error of at most `error`.
double relative_bound(double error, double value);

}  // namespace dolp
