// The scene reader: every key, defaults, axes, and the scenes in host/scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/text.hpp"
#include "scene_support.hpp"
#include "temporary_file.hpp"

namespace dolp::scene_test {
namespace {

const std::string kHostDir = DOLP_HOST_DIR;
constexpr const char* kZenithSky = "surroundings.zenith_temperature_K";
constexpr const char* kHorizonSky = "surroundings.horizon_temperature_K";

// ---- Values --------------------------------------------------------------------------------------------------------

bool is_wind(const std::string& key) { return key.ends_with(".wind_m_s"); }
bool is_of_layer(const std::string& key) { return key.starts_with("surface.coating."); }

/// Other settings without which a scene cannot have this key.
std::vector<std::string> companions_of(const std::string& key) {
  if (key == "source.scale") return {"source.irradiance=1"};
  if (key == "spectrum.response_per") return {"spectrum.response_file=" + kHostDir + "/scenes/microbolometer.csv"};
  if (key == "surroundings.air_temperature_K") return {"surroundings.profile=clear-sky"};
  if (key == kZenithSky) return {std::string(kHorizonSky) + "=285"};
  if (key == kHorizonSky) return {std::string(kZenithSky) + "=285.5"};
  if (key == "surroundings.vapour_cm") return {"surroundings.profile=clear-sky", "surroundings.air_temperature_K=330"};
  if (is_wind(key)) return {"surface.distribution=gaussian"};
  if (key == "surface.wind_model")
    return {"surface.distribution=gaussian", "surface.wind_m_s=5", "surface.masking=none"};
  if (key.ends_with(".sigma_cross")) return {"surface.masking=none"};
  if (key == "grid.view_zenith_deg" || key == "grid.relative_azimuth_deg") return {"geometry.mode=bistatic"};
  if (key.starts_with("surface.coating.1.material")) return {"surface.coating=[{thickness_um=1}]"};
  if (is_of_layer(key)) return {"surface.coating=[{n=1.5,thickness_um=1}]"};
  return {};
}

void expect_defaults(const SceneValues& scene) {
  EXPECT_TRUE(scene.surface.material.is_constant());
  EXPECT_EQ(scene.surface.material.at(10.6), (OpticalConstants{1.5, 0.0}));
  EXPECT_EQ(scene.surface.distribution, Distribution::kCauchy);
  EXPECT_EQ(scene.surface.masking, Masking::kIntegral);
  EXPECT_EQ(scene.surface.sigma, 0.3);
  EXPECT_EQ(scene.surface.q, 2.0);
  EXPECT_EQ(scene.surface.specular, 1.0);
  EXPECT_EQ(scene.surface.diffuse, 0.0);
  EXPECT_EQ(scene.surface.diffuse_exponent, -0.5);
  ASSERT_TRUE(scene.emission);
  EXPECT_EQ(scene.emission->temperature_K, 300.0);
  EXPECT_EQ(scene.emission->model, EmissionModel::kMoments);
  EXPECT_EQ(scene.source.value_or(Source{}).scale, 1.0);
  EXPECT_EQ(scene.path.value_or(Path{}).transmittance, 1.0);
  EXPECT_EQ(scene.geometry.mode, Mode::kHemispherical);
  EXPECT_EQ(scene.geometry.view_zenith_deg, 60.0);
  EXPECT_EQ(scene.geometry.relative_azimuth_deg, 180.0);
  ASSERT_EQ(scene.grid[Axis::kTheta].size(), 91U);
  for (std::size_t i = 0; i < 91; ++i) EXPECT_EQ(scene.grid[Axis::kTheta][i], static_cast<double>(i));
  EXPECT_EQ(scene.grid[Axis::kSigma], std::vector<double>{0.3});
  EXPECT_EQ(scene.grid[Axis::kQ], std::vector<double>{2.0});
  EXPECT_EQ(scene.accuracy.tolerance, 1e-4);
  EXPECT_EQ(scene.accuracy.precision, Precision::kAuto);
}

TEST(Scene_Minimal, GetsEveryDefault) {
  const SceneValues scene = parse(kMinimal);
  expect_defaults(scene);
  EXPECT_EQ(scene.title, "");
  EXPECT_FALSE(scene.source || scene.surroundings || scene.path);
  EXPECT_FALSE(scene.spectrum.is_band());
  EXPECT_EQ(scene.spectrum.min_um, 10.6);
  EXPECT_EQ(scene.text, kMinimal);
  EXPECT_EQ(scene.path_name, "s.toml");
  EXPECT_TRUE(scene.settings.empty());
}

TEST(Scene_Described, DefaultsAreTheRealOnes) {
  const std::vector<std::string> base = {"source.irradiance=1", "path.radiance=1"};
  expect_defaults(parse(kMinimal, base));
  for (const Key& key : dolp::keys()) {
    if (key.layer > 0) continue;  // by default a scene has no films
    const bool is_value = !key.fallback.empty() && key.fallback != "required" && !key.fallback.starts_with("surface.");
    if (!is_value || key.key == "surface.wind_model") continue;  // its wind changes the default of sigma
    SCOPED_TRACE(key.key);
    std::vector<std::string> overrides = base;
    const std::vector<std::string> needed = companions_of(key.key);
    overrides.insert(overrides.end(), needed.begin(), needed.end());
    overrides.push_back(key.key + "=" + key.fallback);
    expect_defaults(parse(kMinimal, overrides));
  }
}

/// A key with a value that is not its default. `arrived` is true if the scene has this value.
struct KeyCase {
  const char* key;
  const char* value;
  bool (*arrived)(const SceneValues&);
};

using At = const SceneValues&;

template <class... Doubles>
bool is(const std::vector<double>& values, Doubles... expected) {
  return values == std::vector<double>{expected...};
}

const std::vector<KeyCase>& key_cases() {
  static const std::vector<KeyCase> cases = {
      {"title", "\"Name\"", [](At s) { return s.title == "Name"; }},
      {"surface.n", "1.25", [](At s) { return s.surface.material.constant.n == 1.25; }},
      {"surface.k", "0.25", [](At s) { return s.surface.material.constant.k == 0.25; }},
      {"surface.material", "\"iron\"", [](At s) { return s.surface.material.name == "iron"; }},
      {"surface.material_file", "\"index.csv\"", [](At s) { return s.surface.material.at(10.0).n == 2.0; }},
      {"surface.reflectance_file", "\"reflectance.csv\"", [](At s) { return s.surface.reflectance != nullptr; }},
      {"surface.distribution", "\"gaussian\"", [](At s) { return s.surface.distribution == Distribution::kGaussian; }},
      {"surface.sigma", "0.5", [](At s) { return s.surface.sigma == 0.5 && s.grid[Axis::kSigma][0] == 0.5; }},
      {"surface.wind_m_s", "5",
       [](At s) {
         return s.surface.sigma == std::sqrt(0.0286 / 2) && s.grid[Axis::kSigma][0] == s.surface.sigma &&
                is(s.wind_m_s, 5.0);
       }},
      {"surface.wind_model", "\"directional\"",
       [](At s) {
         return s.surface.wind_model == WindModel::kDirectional &&
                std::abs(s.surface.sigma - std::sqrt(0.0158)) < 1e-12;
       }},
      {"surface.sigma_cross", "0.5", [](At s) { return s.surface.sigma_cross == 0.5; }},
      {"surface.q", "3", [](At s) { return s.surface.q == 3.0 && s.grid[Axis::kQ][0] == 3.0; }},
      {"surface.masking", "\"v-cavity\"", [](At s) { return s.surface.masking == Masking::kVCavity; }},
      {"surface.scattering", "\"single\"", [](At s) { return s.surface.scattering == Scattering::kSingle; }},
      {"surface.specular", "0.5", [](At s) { return s.surface.specular == 0.5; }},
      {"surface.diffuse", "0.25", [](At s) { return s.surface.diffuse == 0.25; }},
      {"surface.diffuse_file", "\"diffuse.csv\"", [](At s) { return s.surface.diffuse == 0.25; }},
      {"surface.diffuse_exponent", "-0.25", [](At s) { return s.surface.diffuse_exponent == -0.25; }},
      {"surface.diffuse_polarisation", "\"transmission\"",
       [](At s) { return s.surface.diffuse_polarisation == DiffusePolarisation::kTransmission; }},
      {"surface.coating.1.n", "1.25", [](At s) { return s.surface.coating[0].material.constant.n == 1.25; }},
      {"surface.coating.1.k", "0.25", [](At s) { return s.surface.coating[0].material.constant.k == 0.25; }},
      {"surface.coating.1.material", "\"iron\"", [](At s) { return s.surface.coating[0].material.name == "iron"; }},
      {"surface.coating.1.material_file", "\"index.csv\"",
       [](At s) { return s.surface.coating[0].material.at(10.0).n == 2.0; }},
      {"surface.coating.1.thickness_um", "2", [](At s) { return s.surface.coating[0].thickness_um == 2.0; }},
      {"surface.coating.1.thickness_spread_um", "0.5",
       [](At s) { return s.surface.coating[0].thickness_spread_um == 0.5; }},
      {"emission.temperature_K", "290", [](At s) { return s.emission->temperature_K == 290.0; }},
      {"emission.model", "\"fresnel\"", [](At s) { return s.emission->model == EmissionModel::kFresnel; }},
      {"emission.bracket", "false", [](At s) { return !s.emission->has_bracket; }},
      {"source.irradiance", "0.5", [](At s) { return !s.source->relative_irradiance && s.source->irradiance == 0.5; }},
      {"source.relative_irradiance", "0.5", [](At s) { return s.source->relative_irradiance == 0.5; }},
      {"source.preset", "\"sun\"", [](At s) { return s.source->table != nullptr; }},
      {"source.file", "\"light.csv\"", [](At s) { return s.source->table->at(10.5) == 1.5; }},
      {"source.scale", "0.75", [](At s) { return s.source->scale == 0.75; }},
      {"surroundings.temperature_K", "0", [](At s) { return s.surroundings->temperature_K == 0.0; }},
      {kZenithSky, "220", [](At s) { return s.surroundings->zenith_K == 220.0 && s.surroundings->profile; }},
      {kHorizonSky, "285", [](At s) { return s.surroundings->horizon_K == 285.0 && s.surroundings->profile; }},
      {"surroundings.profile", "\"overcast\"", [](At s) { return s.surroundings->profile != nullptr; }},
      {"surroundings.vapour_cm", "1", [](At s) { return *s.surroundings->air.vapour_cm == 1.0; }},
      {"surroundings.air_temperature_K", "280", [](At s) { return s.surroundings->profile->air_K == 280.0; }},
      {"path.transmittance", "0.5", [](At s) { return s.path->transmittance == 0.5; }},
      {"path.temperature_K", "280", [](At s) { return *s.path->temperature_K == 280.0; }},
      {"path.radiance", "2.5", [](At s) { return *s.path->radiance == 2.5; }},
      {"spectrum.wavelength_um", "10.61", [](At s) { return s.spectrum.max_um == 10.61; }},
      {"spectrum.band_um", "[8, 14]", [](At s) { return s.spectrum.min_um == 8 && s.spectrum.max_um == 14; }},
      {"spectrum.response_file", "\"light.csv\"", [](At s) { return s.spectrum.weight(10.5) == 1.5; }},
      {"spectrum.response_per", "\"photon\"", [](At s) { return s.spectrum.photon_um == 10.0; }},
      {"geometry.mode", "\"bistatic\"", [](At s) { return s.geometry.mode == Mode::kBistatic; }},
      {"geometry.view_zenith_deg", "45", [](At s) { return s.geometry.view_zenith_deg == 45.0; }},
      {"geometry.relative_azimuth_deg", "-90", [](At s) { return s.geometry.relative_azimuth_deg == -90.0; }},
      {"geometry.surface_azimuth_deg", "30", [](At s) { return s.geometry.surface_azimuth_deg == 30.0; }},
      {"grid.theta_deg", "[90, 0]", [](At s) { return is(s.grid[Axis::kTheta], 90.0, 0.0); }},
      {"grid.view_zenith_deg", "[10, 70]", [](At s) { return is(s.grid[Axis::kViewZenith], 10.0, 70.0); }},
      {"grid.relative_azimuth_deg", "[-90, 90]", [](At s) { return is(s.grid[Axis::kRelativeAzimuth], -90.0, 90.0); }},
      {"grid.sigma", "0.7", [](At s) { return is(s.grid[Axis::kSigma], 0.7); }},
      {"grid.wind_m_s", "[0, 5]",
       [](At s) {
         return is(s.grid[Axis::kSigma], std::sqrt(0.003 / 2), std::sqrt(0.0286 / 2)) && is(s.wind_m_s, 0.0, 5.0) &&
                s.surface.sigma == s.grid[Axis::kSigma][0];
       }},
      {"grid.material", "[\"iron\", \"silver\"]",
       [](At s) { return is(s.grid[Axis::kMaterial], 0.0, 1.0) && s.materials->at(1).name == "silver"; }},
      {"grid.band_um", "[[8, 9], [10, 12]]",
       [](At s) { return is(s.grid[Axis::kBand], 0.0, 1.0) && s.bands[1].max_um == 12.0 && s.spectrum.max_um == 9.0; }},
      {"grid.temperature_K", "[280, 300]", [](At s) { return is(s.grid[Axis::kTemperature], 280.0, 300.0); }},
      {"grid.q", "[1.5, 2]", [](At s) { return is(s.grid[Axis::kQ], 1.5, 2.0); }},
      {"grid.sigma_cross", "[0.2, 0.4]",
       [](At s) { return is(s.grid[Axis::kSigmaCross], 0.2, 0.4) && s.surface.sigma_cross == 0.2; }},
      {"grid.surface_azimuth_deg", "[0, 45]", [](At s) { return is(s.grid[Axis::kSurfaceAzimuth], 0.0, 45.0); }},
      {"grid.wavelength_um", "[8, 10]", [](At s) { return is(s.grid[Axis::kWavelength], 8.0, 10.0); }},
      {"grid.n", "[1.3, 2]", [](At s) { return is(s.grid[Axis::kN], 1.3, 2.0); }},
      {"grid.k", "0.5", [](At s) { return is(s.grid[Axis::kK], 0.5); }},
      {"accuracy.tolerance", "1e-6", [](At s) { return s.accuracy.tolerance == 1e-6; }},
      {"accuracy.precision", "\"double\"", [](At s) { return s.accuracy.precision == Precision::kDouble; }},
      {"accuracy.interpolation", "\"off\"", [](At s) { return !s.accuracy.may_interpolate; }},
  };
  return cases;
}

/// All keys except the keys of the second and further films, whose names differ only in the number of the film.
std::vector<Key> listed_keys() {
  std::vector<Key> keys;
  std::ranges::copy_if(dolp::keys(), std::back_inserter(keys), [](const Key& key) { return key.layer <= 1; });
  return keys;
}

TEST(Scene_EveryKey, HasACaseBelow) {
  const std::vector<Key> keys = listed_keys();
  ASSERT_EQ(key_cases().size(), keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) EXPECT_EQ(keys[i].key, key_cases()[i].key);
}

TEST(Scene_EveryKey, IsDescribed) {
  for (const Key& key : dolp::keys()) {
    EXPECT_FALSE(key.meaning.empty()) << key.key;
    EXPECT_FALSE(key.allowed().empty()) << key.key;
    EXPECT_EQ(key.type == Key::Type::kWord || key.type == Key::Type::kFlag, !key.words.empty()) << key.key;
  }
}

TEST(Scene_EveryKey, CanBeSetByAnOverride_AndBeWrittenInTheFile) {
  const TemporaryFolder folder;
  const auto put = [&](const char* name, const char* text) { std::ofstream(folder.path() / name) << text; };
  put("index.csv", "wavelength_um,n,k\n10,2,0\n11,2,0\n");
  put("light.csv", "10,1\n11,2\n");
  put("diffuse.csv", "wavelength_um,reflectance\n10.6,0.25\n11,1\n");
  put("reflectance.csv", "beta_deg,r_s,r_p\n0,0.1,0.1\n90,1,1\n");
  const std::string path = folder.path() / "s.toml";
  for (const KeyCase& row : key_cases()) {
    SCOPED_TRACE(row.key);
    std::vector<std::string> overrides = companions_of(row.key);
    overrides.push_back(std::string(row.key) + "=" + row.value);
    const SceneValues scene = parse_scene(kMinimal, path, settings_from_text(overrides, "--set"));
    EXPECT_TRUE(row.arrived(scene));
    EXPECT_EQ(scene.settings, settings_from_text(overrides));
    const std::string text = scene_toml(scene, folder.path());
    EXPECT_TRUE(row.arrived(parse_scene(text, path, {}))) << text;
  }
}

TEST(Scene_EveryNumber, AcceptsItsClosedEndsAndRefusesItsOpenOnes) {
  for (const Key& key : listed_keys()) {
    if (key.type != Key::Type::kNumber) continue;
    const std::vector<std::string> base = companions_of(key.key);
    for (const double end : {key.range.min, key.range.max}) {
      if (std::isinf(end)) continue;
      std::vector<std::string> overrides = base;
      overrides.push_back(key.key + "=" + format_number(end));
      const std::string error = error_of(kMinimal, overrides);
      EXPECT_EQ(error == "no error", key.range.contains(end)) << overrides.back() << ": " << error;
    }
  }
}

TEST(Scene_EveryNumber, RefusesWhatIsOutOfRangeNotFiniteOrNoNumber) {
  const std::string kBeyondDoubles = "9007199254740993";  // 2^53 + 1, which no double holds
  EXPECT_EQ(parse(kMinimal + "[source]\nirradiance = " + kBeyondDoubles).source->irradiance, 9007199254740993.0);
  for (const Key& key : listed_keys()) {
    if (key.type != Key::Type::kNumber && key.type != Key::Type::kAxis) continue;
    std::vector<std::string> values = {"nan", "inf", "-inf", "true", "many", "2020-01-01", ""};
    if (std::isfinite(key.range.min)) values.push_back(format_number(key.range.min - 1.0));
    if (std::isfinite(key.range.max)) {
      values.push_back(format_number(key.range.max * 2.0 + 1.0));
      values.push_back(kBeyondDoubles);
    }
    for (const std::string& value : values) {
      const std::string argument = key.key + "=" + value;
      std::vector<std::string> overrides = is_of_layer(key.key) ? companions_of(key.key) : std::vector<std::string>{};
      overrides.push_back(argument);
      const std::string error = error_of(kMinimal, overrides);
      EXPECT_TRUE(error.starts_with("--set " + argument + ": ")) << error;
      EXPECT_TRUE(contains(error, key.range.text())) << error;
    }
  }
}

TEST(Scene_EveryWord, NamesTheAllowedWords) {
  for (const Key& key : listed_keys()) {
    if (key.type != Key::Type::kWord) continue;
    const std::string error = error_of(kMinimal, {key.key + "=nonsense"});
    for (const std::string& word : key.words) EXPECT_TRUE(contains(error, word)) << error;
    // The scene has v-cavity masking, because some words are allowed only with it.
    for (const std::string& word : key.words) {
      std::vector<std::string> overrides = companions_of(key.key);
      overrides.insert(overrides.end(), {"surface.masking=v-cavity", key.key + "=" + word});
      EXPECT_EQ(error_of(kMinimal, overrides), "no error");
    }
  }
}

TEST(SceneScattering, WhatTheModelHas_Arrives) {
  const SceneValues multiple =
      parse_scene(kMinimal, "s.toml", {{"surface.masking", "v-cavity"}, {"surface.scattering", "multiple"}});
  EXPECT_EQ(multiple.surface.scattering, Scattering::kMultiple);
  const SceneValues direct = parse_scene(
      kMinimal, "s.toml", {{"surface.masking", "v-cavity"}, {"emission.model", "direct"}, {"emission.bracket", true}});
  EXPECT_EQ(direct.emission->model, EmissionModel::kDirect);
  EXPECT_TRUE(direct.emission->has_bracket);
}

// ---- Axes ----------------------------------------------------------------------------------------------------------

TEST(SceneAxis_InEachForm, HasItsValues) {
  const std::string grid = "[grid]\ntheta_deg = ";
  for (const auto& [text, values] :
       {std::pair(grid + "{ from = 80, to = 10, count = 8 }", std::vector<double>{80, 70, 60, 50, 40, 30, 20, 10}),
        {grid + "[30, 0, 60]", {0, 30, 60}},  // a list is sorted unless it ascends or descends
        {grid + "[60, 30, 0]", {60, 30, 0}},
        {grid + "30", {30}},
        {grid + "[30]", {30}},
        {grid + "{ from = 30, to = 30, count = 1 }", {30}},
        {"[grid.theta_deg]\nfrom = 2\nto = 4\ncount = 3", {2, 3, 4}}}) {
    EXPECT_EQ(parse(kMinimal + text).grid[Axis::kTheta], values) << text;
  }
}

TEST(SceneAxis_Log, HasExactEndsAndEqualRatios) {
  const SceneValues scene = parse(kMinimal + "[grid]\nsigma = { from = 0.01, to = 1, count = 3, spacing = \"log\" }\n");
  // The value in the middle is 0.01^0.5 * 1^0.5. Both powers and their product have a rounding error.
  constexpr double kTwoPowers = 3.0 * 2.3e-16;
  ASSERT_EQ(scene.grid[Axis::kSigma].size(), 3U);
  EXPECT_EQ(scene.grid[Axis::kSigma][0], 0.01);
  EXPECT_NEAR(scene.grid[Axis::kSigma][1], 0.1, 0.1 * kTwoPowers);
  EXPECT_EQ(scene.grid[Axis::kSigma][2], 1.0);
}

TEST(SceneGrid_SigmaWithoutSurfaceSigma, GivesTheSurfaceItsFirstValue) {
  const SceneValues scene =
      parse("surface.n = 1.5\nemission.temperature_K = 1\nspectrum.wavelength_um = 5\ngrid.sigma = [0.2, 0.1]");
  EXPECT_EQ(scene.surface.sigma, 0.2);
}

// ---- The shipped scenes --------------------------------------------------------------------------------------------

TEST(ShippedScenes, AllParse) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kHostDir + "/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    const SceneValues scene = read_scene(entry.path().string(), {});
    EXPECT_FALSE(scene.title.empty()) << entry.path();
    const auto& theta = scene.grid[Axis::kTheta];
    EXPECT_NE(std::find(theta.begin(), theta.end(), 60.0), theta.end()) << entry.path();
    const std::vector<Setting> smith = {{"surface.masking", "smith"}, {"surface.scattering", "single"}};
    if (!scene.surface.has_cross_slopes()) {
      EXPECT_NO_THROW(read_scene(entry.path().string(), smith)) << entry.path();
    }
    ++count;
  }
  EXPECT_EQ(count, 24U);
}

TEST(ShippedScenes_OfThePaper, HaveItsSamples) {
  const SceneValues steel = read_scene(kHostDir + "/scenes/stainless_steel.toml", {});
  EXPECT_EQ(steel.surface.material.constant, (OpticalConstants{1.508, 0.0}));
  EXPECT_EQ(steel.surface.sigma, 0.445);
  EXPECT_EQ(steel.emission->temperature_K, 298.15);
  const SceneValues aluminium = read_scene(kHostDir + "/scenes/aviation_aluminium.toml", {});
  EXPECT_EQ(aluminium.surface.material.constant, (OpticalConstants{1.373, 0.0}));
  EXPECT_EQ(aluminium.surface.sigma, 0.905);
  EXPECT_EQ(aluminium.emission->temperature_K, 299.15);
}

}  // namespace
}  // namespace dolp::scene_test
