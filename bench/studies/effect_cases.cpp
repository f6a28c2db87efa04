#include "studies/effect_cases.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <memory>

#include "model/choices.hpp"

namespace dolp::bench {
namespace {

constexpr double kTemperature = 298.15;  // temperature of the surface, K
constexpr double kLastTheta = 85.0;
constexpr double kFirstSigma = 0.05;
constexpr double kLastSigma = 1.0;
constexpr double kIrradiance = 20.0;  // of the source at 10.6 um, W m-2 um-1; a black body at kTemperature emits 30
constexpr double kSunAtTenUm = 0.18;  // sunlight above the atmosphere at 10.6 um, W m-2 um-1
constexpr double kSunInVisible = 1800.0;
constexpr double kVisible_um = 0.55;
constexpr double kColdSky = 250.0;    // temperature of a cold sky, K
constexpr double kOnePercent = 1e-2;  // a tolerance of DOLP that suits a thermal camera

Axes grid_of(std::size_t entries) {
  const auto side = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(entries))));
  const std::size_t thetas = std::max<std::size_t>(2, side);
  const std::size_t sigmas = std::max<std::size_t>(2, entries / thetas);
  Axes grid;
  for (std::size_t i = 0; i < thetas; ++i) {
    grid[Axis::kTheta].push_back(kLastTheta * static_cast<double>(i) / static_cast<double>(thetas - 1));
  }
  for (std::size_t i = 0; i < sigmas; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(sigmas - 1);
    grid[Axis::kSigma].push_back(kFirstSigma * std::pow(kLastSigma / kFirstSigma, share));
  }
  grid[Axis::kQ] = {3.0};
  return grid;
}

/// The stainless steel of the paper, with emission and no other radiation. The paper gives this n and k = 0
/// (host/scenes/stainless_steel.toml).
SceneValues emitting(const Axes& grid) {
  SceneValues scene;
  scene.surface.material.constant = {1.508, 0.0};
  scene.emission = Emission{kTemperature, EmissionModel::kMoments};
  scene.spectrum.min_um = scene.spectrum.max_um = 10.6;
  scene.grid = grid;
  return scene;
}

/// The emitting steel in bistatic mode, viewed outside the plane of incidence. The caller adds a source.
SceneValues seen_from_one_side(const Axes& grid) {
  SceneValues scene = emitting(grid);
  scene.geometry = {Mode::kBistatic, 60.0, 90.0};
  return scene;
}

/// The bistatic scene under a uniform cold sky. `smith` masking ensures that emissivities are not negative.
SceneValues under_the_sky(const Axes& grid) {
  SceneValues scene = seen_from_one_side(grid);
  scene.surface.masking = Masking::kSmith;
  scene.surroundings = Surroundings{kColdSky};
  return scene;
}

Source flat_source(double irradiance) {
  Source source;
  source.irradiance = irradiance;
  return source;
}

/// A material whose n and k are given at four wavelengths and depend linearly on the wavelength between them.
Material dispersive() {
  Material material;
  material.name = "dispersive";
  material.n = {{8.0, 10.0, 12.0, 14.0}, {1.4, 1.6, 1.5, 1.45}, SpectralTable::Interpolation::kLinear};
  material.k = {{8.0, 10.0, 12.0, 14.0}, {0.05, 0.3, 0.15, 0.1}, SpectralTable::Interpolation::kLinear};
  return material;
}

std::vector<double> spaced(double first, double last, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(first + (last - first) * static_cast<double>(i) / static_cast<double>(count - 1));
  }
  return values;
}

/// A change to the base scene, with its name.
struct Change {
  std::string name;
  std::function<void(SceneValues&)> apply = [](SceneValues&) {};
};

EffectGroup group(const std::string& effect, const SceneValues& base, const std::vector<Change>& changes) {
  EffectGroup made{effect, name_of(base.geometry.mode), {}};
  for (const Change& change : changes) {
    made.settings.push_back({change.name, base});
    change.apply(made.settings.back().scene);
  }
  return made;
}

Change masking(Masking masking) {
  return {name_of(masking), [masking](SceneValues& scene) { scene.surface.masking = masking; }};
}

Change scattering(Scattering scattering) {
  return {name_of(scattering), [scattering](SceneValues& scene) { scene.surface.scattering = scattering; }};
}

Change emission_model(EmissionModel model) {
  return {name_of(model), [model](SceneValues& scene) { scene.emission->model = model; }};
}

Change source(const std::string& name, double irradiance) {
  return {name, [irradiance](SceneValues& scene) { scene.source = flat_source(irradiance); }};
}

Change surroundings(const std::string& name, double temperature_K) {
  return {name, [temperature_K](SceneValues& scene) { scene.surroundings = Surroundings{temperature_K}; }};
}

Change profile(const std::string& name, const SkyProfile& sky) {
  return {name, [sky](SceneValues& scene) {
            scene.surroundings = Surroundings{.profile = std::make_shared<const SkyProfile>(sky)};
          }};
}

/// A sky with temperatures that rise toward the horizon, given every 5 degrees.
SkyProfile sky_of_rows() {
  SkyProfile sky;
  sky.zenith_deg = spaced(0.0, 90.0, 19);
  for (const double zenith_deg : sky.zenith_deg) sky.values.push_back(220.0 + 65.0 * std::pow(zenith_deg / 90.0, 4.0));
  return sky;
}

void set_band(SceneValues& scene) { scene.spectrum = {8.0, 14.0}; }

std::vector<EffectGroup> surface_groups(const SceneValues& base) {
  return {group("specular", base, {{"k_s = 1"}, {"k_s = 0", [](SceneValues& scene) { scene.surface.specular = 0.0; }}}),
          group("diffuse", base, {{"off"}, {"k_d = 0.3", [](SceneValues& scene) { scene.surface.diffuse = 0.3; }}}),
          group("distribution", base,
                {{"cauchy"},
                 {"gaussian", [](SceneValues& scene) { scene.surface.distribution = Distribution::kGaussian; }}}),
          group("masking", base,
                {masking(Masking::kNone), masking(Masking::kVCavity), masking(Masking::kIntegral),
                 masking(Masking::kSmith)}),
          group("complex index", base,
                {{"k = 0"}, {"k = 0.5", [](SceneValues& scene) { scene.surface.material.constant.k = 0.5; }}}),
          group("axes of index", base, {{"one n and k"}, {"20 n x 20 k", [](SceneValues& scene) {
                                                            scene.grid[Axis::kN] = spaced(1.3, 2.5, 20);
                                                            scene.grid[Axis::kK] = spaced(0.01, 1.0, 20);
                                                          }}})};
}

/// Groups for all bounces of the light, for direct emission, and for the bracket. The bracket is a range that contains
/// the DOLP with all bounces. `v-cavity` masking supports these three effects.
std::vector<EffectGroup> scattering_groups(const Axes& grid) {
  SceneValues rough = emitting(grid);
  rough.surface.masking = Masking::kVCavity;
  return {group("scattering", rough, {scattering(Scattering::kSingle), scattering(Scattering::kMultiple)}),
          group("direct emission", rough,
                {emission_model(EmissionModel::kMoments), emission_model(EmissionModel::kDirect)}),
          group("bracket", rough, {{"off"}, {"on", [](SceneValues& scene) { scene.emission->has_bracket = true; }}})};
}

std::vector<EffectGroup> radiation_groups(const SceneValues& base, const SceneValues& bistatic) {
  SceneValues lit = bistatic;
  lit.source = flat_source(kIrradiance);
  return {group("emission", base, {emission_model(EmissionModel::kMoments), emission_model(EmissionModel::kFresnel)}),
          group("emission", lit, {{"on"}, {"off", [](SceneValues& scene) { scene.emission.reset(); }}}),
          group("source", base, {{"off"}, source("on", kIrradiance)}),
          group("source", bistatic, {{"off"}, source("on", kIrradiance)}),
          group("surroundings", base,
                {{"off"}, surroundings("250 K", kColdSky), surroundings("as warm as the surface", kTemperature)}),
          group("profile", base,
                {surroundings("uniform", kColdSky), profile("clear sky", *built_in_sky("clear-sky")),
                 profile("19 rows", sky_of_rows())}),
          group("path", base,
                {{"off"},
                 {"on",
                  [](SceneValues& scene) {
                    scene.path = Path{0.8, 280.0, std::nullopt};
                  }}}),
          group("band", base,
                {{"one wavelength"}, {"8-14 um, constant n", set_band}, {"8-14 um, n(lambda)", [](SceneValues& scene) {
                                                                           set_band(scene);
                                                                           scene.surface.material = dispersive();
                                                                         }}})};
}

/// Two groups with radiation that hardly matters: sunlight at 10.6 um, and thermal emission in visible light.
std::vector<EffectGroup> daylight_groups(const Axes& grid) {
  SceneValues thermal = under_the_sky(grid);
  thermal.accuracy.tolerance = kOnePercent;
  SceneValues visible = under_the_sky(grid);
  visible.spectrum.min_um = visible.spectrum.max_um = kVisible_um;
  visible.source = flat_source(kSunInVisible);
  const auto without_emission = [](SceneValues& scene) {
    scene.emission.reset();
    scene.surroundings.reset();
  };
  return {group("sun at 10.6 um", thermal, {{"off"}, source("on", kSunAtTenUm)}),
          group("emission at 0.55 um", visible, {{"off", without_emission}, {"on"}})};
}

}  // namespace

std::vector<EffectGroup> effect_groups(std::size_t entries) {
  const Axes grid = grid_of(entries);
  const SceneValues base = emitting(grid);
  std::vector<EffectGroup> groups = surface_groups(base);
  for (std::vector<EffectGroup>& more :
       std::array{scattering_groups(grid), radiation_groups(base, seen_from_one_side(grid)), daylight_groups(grid)}) {
    std::ranges::move(more, std::back_inserter(groups));
  }
  return groups;
}

}  // namespace dolp::bench
