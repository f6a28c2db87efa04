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
/// Equation: with the incident exitance X, the exitance pi B of a black body and N = pi B - X, the surface has
/// I = X + N eps_I and Q = N eps_Q. Direct emission eps_I,direct and first reflection rho_I leave the share
/// D = 1 - rho_I - eps_I,direct to later bounces. Of D, an unknown part d is emission, and the rest is reflection. So
/// eps_I is eps_I,direct + d, and eps_Q differs from eps_Q,direct by at most d. DOLP is extreme at d = D, where it is
/// (|sum of N eps_Q,direct| -+ sum of |N| D) / sum of I, with sums over the spectral samples. Under a sky profile it
/// may also be extreme at d = 0, because the reflected light may come from any part of the sky.
struct Bracket {
  double low = 0.0;
  double high = 0.0;
  double error = 0.0;  ///< bound of the absolute errors of low and high
};

/// Sums emission, reflected surroundings and, if `with_source`, reflected light of the source.
Stokes stokes_sum(const SpectralRule& rule, const PerSample<Reflectance>& reflectances,
                  const PerSample<Emissivity>& emissivities, EmissionModel model, double cos_theta, bool with_source);

/// Adds net * r_i to I and net * r_q to Q. The moments r_i and r_q are rho_I cos(theta) and rho_Q cos(theta).
void add_specular(Stokes& sum, double net, const Moments& moments);

/// Diffuse reflection in a spectral sample. `beyond_mean` is the difference of two means of the sky's exitance. The
/// first is DiffuseReflection::sky_mean. The second is SpectralFactors::surroundings.
struct DiffuseSample {
  DiffuseLight rho;
  Estimate beyond_mean;
};

/// Adds the reflected light of a sky profile, minus the reflected light of a uniform sky with the same irradiance. The
/// specular part of this difference is Surface::specular / cos(theta) times the sum of Moments::columns with `weights`.
/// The diffuse part is DiffuseSample::rho times beyond_mean. `weights` is the result of sky_weights().
void add_sky(Stokes& sum, const Surface& surface, const SpectralRule& rule, std::span<const SkyWeights> weights,
             const PerSample<DiffuseSample>& diffuse, std::span<const Moments> moments, double cos_theta);

void add_specular_sky(Stokes& sum, double specular, double rounding, const SkyWeights& weights, const Moments& moments);

/// Adds pi E0 cos(theta_i) f: the source's reflected light, with the pBRDF f. `diffuse`: pi cos(theta_i) f_diffuse.
void add_beam(Stokes& sum, double k_s, const SpectralRule& rule, std::span<const Scattered> scattered,
              const PerSample<DiffuseLight>& diffuse, double cos_theta_r);

void add_path(Stokes& sum, const std::optional<Path>& path, double path_exitance);

Bracket bracket(const SceneModel& scene, const SpectralRule& rule, const PerSample<Reflectance>& reflectances,
                const PerSample<Emissivity>& direct, const Stokes& sky, double cos_theta);

double relative_bound(double error, double value);

}  // namespace dolp
