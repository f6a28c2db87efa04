// Section 4 (radiometry) of shaders/physics/README.md, programmed again in long double. Scenes and moments for tests.
#pragma once

#include <algorithm>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "radiometry/radiometry.hpp"
#include "scene/scene.hpp"

namespace radiometry_support {

using namespace dolp;
using Real = long double;

inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
inline constexpr unsigned kSeed = 20250811;
inline constexpr int kRandomScenes = 2000;
// Relative tolerance. It allows for rounding in double, mainly of the exponent in Planck's law, which is up to 50 here.
inline constexpr double kAgreement = 1e-12;
// Relative accuracy that the program promises for integrals over a band if n and k come from a table.
inline constexpr double kBandAgreement = 1e-9;

// ---- The printed formulas -------------------------------------------------------------------------------------------

inline Real printed_planck(Real wavelength_um, Real temperature_K) {
  if (temperature_K == 0.0L) return 0.0L;
  const Real h = 6.62607015e-34L;
  const Real light = 299792458.0L;
  const Real k_b = 1.380649e-23L;
  const Real wavelength_m = wavelength_um * 1e-6L;
  const Real exponent = h * light / (wavelength_m * k_b * temperature_K);
  return 1e-6L * 2.0L * h * light * light / std::pow(wavelength_m, 5.0L) / std::expm1(exponent);
}

struct PrintedReflectance {
  Real s = 0.0L;
  Real p = 0.0L;
};

inline PrintedReflectance printed_fresnel(const OpticalConstants& index, Real c) {
  using Complex = std::complex<Real>;
  const Complex n(index.n, index.k);
  const Complex w = std::sqrt(n * n - (1.0L - c * c));
  return {std::norm((c - w) / (c + w)), std::norm((n * n * c - w) / (n * n * c + w))};
}

struct PrintedStokes {
  Real i = 0.0L;
  Real q = 0.0L;
};

/// I and Q in the hemispherical mode at one wavelength, by eq. (18) of the paper. `specular` has the reflectances of
/// the rough surface, not yet multiplied by the factor k_s of the scene.
inline PrintedStokes printed_stokes(const SceneValues& scene, Real wavelength_um, Real c,
                                    const PrintedReflectance& specular) {
  const Real pi = std::numbers::pi_v<Real>;
  const Surface& surface = scene.surface;
  const Real diffuse = 2.0L * surface.diffuse * std::pow(c, static_cast<Real>(surface.diffuse_exponent)) /
                       (surface.diffuse_exponent + 2.0L);
  const Real rho_i = surface.specular * (specular.s + specular.p) / 2.0L + diffuse;
  const Real rho_q = surface.specular * (specular.s - specular.p) / 2.0L;
  const Real emitted = scene.emission ? pi * printed_planck(wavelength_um, scene.emission->temperature_K) : 0.0L;
  Real incident = scene.surroundings ? pi * printed_planck(wavelength_um, scene.surroundings->temperature_K) : 0.0L;
  if (scene.source) {
    const Source& source = *scene.source;
    Real irradiance = source.irradiance;
    if (source.relative_irradiance) irradiance = *source.relative_irradiance * emitted;
    if (source.table) irradiance = source.table->at(static_cast<double>(wavelength_um));
    incident += source.scale * irradiance * c;
  }
  PrintedStokes stokes{emitted * (1.0L - rho_i) + incident * rho_i, (incident - emitted) * rho_q};
  if (scene.emission && scene.emission->model == EmissionModel::kFresnel) {
    const PrintedReflectance smooth = printed_fresnel(surface.material.at(static_cast<double>(wavelength_um)), c);
    const Real epsilon_s = 1.0L - smooth.s;
    const Real epsilon_p = 1.0L - smooth.p;
    stokes = {emitted * (epsilon_s + epsilon_p) / 2.0L + incident * rho_i,
              emitted * (epsilon_s - epsilon_p) / 2.0L + incident * rho_q};
  }
  if (scene.path) {
    const Path& path = *scene.path;
    Real radiance = 0.0L;
    if (path.radiance) radiance = *path.radiance;
    if (path.temperature_K) radiance = (1.0L - path.transmittance) * printed_planck(wavelength_um, *path.temperature_K);
    stokes = {path.transmittance * stokes.i + pi * radiance, path.transmittance * stokes.q};
  }
  return stokes;
}

/// Integral of `f` from the first to the last of the ascending `points`. The derivative of `f` may jump only at these.
inline Real integral(const std::vector<double>& points, const std::function<Real(Real)>& f) {
  boost::math::quadrature::tanh_sinh<Real> rule;
  Real sum = 0.0L;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) sum += rule.integrate(f, Real(points[i]), Real(points[i + 1]));
  return sum;
}

// ---- Scenes and moments ---------------------------------------------------------------------------------------------

inline SceneValues night_scene() {
  SceneValues scene;
  scene.path_name = "night.toml";
  scene.surface.material.constant = {1.5, 0.1};
  scene.surface.masking = Masking::kSmith;
  scene.surface.specular = 0.97;
  scene.surface.diffuse = 0.03;
  scene.surface.diffuse_exponent = -0.3;
  scene.emission = Emission{290.0, EmissionModel::kMoments};
  scene.surroundings = Surroundings{240.0};
  scene.spectrum = {10.6, 10.6};
  return scene;
}

inline Moments moments_of(const PrintedReflectance& specular, double cos_theta) {
  Moments m;
  const Real rho_i = (specular.s + specular.p) / 2.0L;
  m.r_i = static_cast<double>(rho_i * cos_theta);
  m.r_q = static_cast<double>((specular.s - specular.p) / 2.0L * cos_theta);
  m.deficit = static_cast<double>((1.0L - rho_i) * cos_theta);
  m.albedo = cos_theta;
  return m;
}

inline Direction direction_of(double theta_deg) { return {theta_deg, std::cos(theta_deg * std::numbers::pi / 180.0)}; }

inline PointResult evaluate(const SceneValues& scene, const Direction& direction, const Moments& moments) {
  return Radiometry(scene).point(direction, std::vector<Moments>{moments});
}

class RandomScenes {
 public:
  RandomScenes() : generator_(kSeed) {}
  double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(generator_); }
  bool coin() { return std::bernoulli_distribution(0.5)(generator_); }
  SceneValues next() {
    SceneValues scene = night_scene();
    scene.surface.material.constant = {uniform(0.2, 5.0), coin() ? 0.0 : uniform(0.0, 50.0)};
    scene.surface.specular = uniform(0.0, 1.0);
    scene.surface.diffuse = coin() ? 0.0 : uniform(0.0, 0.3);
    scene.surface.diffuse_exponent = uniform(-0.99, 0.0);
    scene.spectrum.min_um = scene.spectrum.max_um = uniform(3.0, 14.0);
    if (coin()) scene.spectrum.max_um += uniform(0.1, 5.0);
    scene.emission->temperature_K = uniform(200.0, 500.0);
    if (coin()) scene.emission->model = EmissionModel::kFresnel;
    scene.surroundings->temperature_K = uniform(0.0, 400.0);
    scene.source = Source{};
    scene.source->irradiance = uniform(0.0, 30.0);
    const double relative_irradiance = uniform(0.0, 3.0);
    if (!coin()) scene.source->relative_irradiance = relative_irradiance;
    scene.source->scale = uniform(0.1, 2.0);
    scene.path = Path{uniform(0.0, 1.0), std::nullopt, std::nullopt};
    if (coin()) {
      scene.path->temperature_K = uniform(0.0, 300.0);
    } else {
      scene.path->radiance = uniform(0.0, 3.0);
    }
    drop_effects(scene);
    return scene;
  }
  PrintedReflectance reflectance() { return {uniform(0.0, 1.0), uniform(0.0, 1.0)}; }

 private:
  void drop_effects(SceneValues& scene) {
    if (coin()) scene.surroundings.reset();
    if (coin()) scene.path.reset();
    if (coin()) scene.source.reset();
    const bool needed = !scene.surroundings && !scene.path && !scene.source;
    if (!needed && scene.source && !scene.source->relative_irradiance && coin()) scene.emission.reset();
  }
  std::mt19937_64 generator_;
};

/// A material whose index varies as at a resonance. n and k are given at different wavelengths with unequal steps.
inline Material tabulated_material() {
  Material material;
  material.name = "test glass";
  material.n.wavelength_um = {7.0, 8.3, 8.9, 9.6, 10.4, 11.7, 13.0, 15.0};
  material.n.value = {1.1, 0.6, 1.4, 2.7, 2.2, 1.7, 1.5, 1.5};
  material.k.wavelength_um = {7.0, 8.6, 9.2, 10.4, 12.0, 15.0};
  material.k.value = {0.02, 1.1, 1.6, 0.3, 0.1, 0.1};
  return material;
}

/// The ends of the band, and all wavelengths inside it at which the slope of n, k or the irradiance jumps.
inline std::vector<double> corners(const SceneValues& scene) {
  std::vector<double> points = {scene.spectrum.min_um, scene.spectrum.max_um};
  const auto add = [&](const SpectralTable& table) {
    for (const double at : table.wavelength_um)
      if (at > scene.spectrum.min_um && at < scene.spectrum.max_um) points.push_back(at);
  };
  add(scene.surface.material.n);
  add(scene.surface.material.k);
  if (scene.source && scene.source->table) add(*scene.source->table);
  std::ranges::sort(points);
  return points;
}

}  // namespace radiometry_support
