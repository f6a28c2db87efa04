// Stokes parameters summed over the spectral samples, with bounds of their errors.
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

/// Sums over the spectral samples, with bounds of their errors.
struct Stokes {
  double i = 0.0;
  double q = 0.0;
  double i_error = 0.0;
  double q_error = 0.0;
  double u = 0.0;
  double v = 0.0;
  double u_error = 0.0;
};

/// Lower and upper bound of the DOLP of a surface with these facets and all bounces.
///
/// Equation: its eps_I exceeds the direct one by d <= D = 1 - rho_I - eps_I,direct, which changes eps_Q by at most d. I
/// = X + N eps_I and Q = N eps_Q with N = pi B - X, where X is the exitance of source and surroundings. Both ends lie
/// at d = D, where I equals the I of single scattering: (|sum N eps_Q,direct| -+ sum |N| D) / I. Under a sky X is the
/// middle of its radiance, and single scattering adds the reflected difference from the middle. The light D - d of
/// later bounces comes from an unknown part of the sky, which is within M of the middle. So the ends may also lie at d
/// = 0, where Q and I are within M D of their values with X.
struct Bracket {
  double low = 0.0;
  double high = 0.0;
  double error = 0.0;  ///< bound of the absolute error of each end
};

/// Exitances by emission, by reflection of the surroundings and, with `with_source`, by reflection of the source into
/// the hemisphere.
Stokes stokes_sum(const SpectralRule& rule, std::span<const Reflectance> reflectances,
                  std::span<const Emissivity> emissivities, EmissionModel model, double cos_theta, bool with_source);

/// Adds a specular term `net` * r, with cos(theta) in r.
void add_specular(Stokes& sum, double net, const Moments& moments);

/// The diffuse part of rho in a sample, and what a sky adds to the mean of its exitance.
struct DiffuseSample {
  DiffuseLight rho;
  double beyond_mean = 0.0;
};

/// Adds what a sky reflects beyond its mean; `weights` is empty without one.
///
/// Equation: pi (S - mean(L) rho) = k_s / cos(theta) sum w_k r_k + rho_diffuse (mean_diffuse(L) - mean(L)) in I and in
/// Q: r_k are the moments with the functions of the basis, w_k the sample's weights.
void add_sky(Stokes& sum, const Surface& surface, const SpectralRule& rule, std::span<const SkyWeights> weights,
             std::span<const DiffuseSample> diffuse, std::span<const Moments> moments, double cos_theta);

/// Adds only the specular part of what a sky reflects beyond its mean, with cos(theta) in r.
void add_specular_sky(Stokes& sum, double specular, double rounding, const SkyWeights& weights, const Moments& moments);

/// Adds pi E0 cos(theta_i) f of the beam from the source. The factor pi converts to the exitances of the sum. `diffuse`
/// is pi cos(theta_i) f of the diffuse part.
void add_beam(Stokes& sum, double k_s, const SpectralRule& rule, std::span<const Scattered> scattered,
              std::span<const DiffuseLight> diffuse, double cos_theta_r);

/// Applies a path: multiplies the sums by its transmittance and adds its radiance.
void add_path(Stokes& sum, const std::optional<Path>& path, double path_exitance);

/// `sky` is the result of add_sky.
Bracket bracket(const SceneModel& scene, const SpectralRule& rule, std::span<const Reflectance> reflectances,
                std::span<const Emissivity> direct, const Stokes& sky, double cos_theta);

/// Bound of the relative error, from the bound of the absolute error.
double relative_bound(double error, double value);

}  // namespace dolp
