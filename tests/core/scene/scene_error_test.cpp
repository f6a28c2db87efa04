// Errors of the scene reader: every error that a scene can have, and errors of overrides.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <iostream>
#include <map>
#include <random>

#include "base/text.hpp"
#include "error_text.hpp"
#include "scene/scene_document.hpp"
#include "scene/scene_keys.hpp"
#include "scene_support.hpp"
#include "temporary_file.hpp"

namespace dolp::scene_error_test {
namespace {

const std::string kHostDir = DOLP_HOST_DIR;

// ---- Errors --------------------------------------------------------------------------------------------------------

TEST(SceneError_InTheFile, NamesFileLineKeyValueAndWhatIsAllowed) {
  // Text that makes kMinimal wrong if it is appended as line 8, and text that the message must contain.
  using Row = std::pair<const char*, std::vector<const char*>>;
  for (const auto& [appended, expected] : std::vector<Row>{
           {"[surfaces]\n", {"s.toml:8: surfaces: unknown key", "surface"}},
           {"wavelenght_um = 3\n", {"s.toml:8: spectrum.wavelenght_um = 3: unknown key", "spectrum.wavelength_um"}},
           {"[grid]\nview_zenith_deg = 3\n",
            {"s.toml:9: grid.view_zenith_deg = 3: needs geometry.mode = \"bistatic\""}},
           {"[grid]\nview_zenith = 3\n", {"s.toml:9: grid.view_zenith = 3: unknown key", "view_zenith_deg"}},
           {"[path]\ntemperature_k = 3\n", {"s.toml:9: path.temperature_k", "nearest known key is path.temperature_K"}},
           {"[geometry]\nmode = \"bistatical\"\n",
            {"s.toml:9: geometry.mode = \"bistatical\": ", "hemispherical, bistatic"}},
           {"[geometry]\nmode = 1\n", {"s.toml:9: geometry.mode = 1: ", "hemispherical, bistatic"}},
           {"[grid]\ntheta_deg = [0, 91]\n", {"s.toml:9: grid.theta_deg = [", "91 is out of range", "[0, 90]"}},
           {"[grid]\ntheta_deg = \"0:90:10\"\n",
            {"s.toml:9: grid.theta_deg = ", "or a range { from = ..., to = ..., count = ... }"}},
           {"[grid]\ntheta_deg = []\n", {"s.toml:9: grid.theta_deg = []: the list is empty"}},
           {"[grid]\nq = [2, \"3\"]\n", {"s.toml:9: grid.q = [", "(1, 1e4]"}},
           {"[grid]\nq = [2, 3, 2.0]\n", {"s.toml:9: grid.q = [", "2 appears twice"}},
           {"[grid]\nq = { from = 2, to = 3 }\n", {"s.toml:9: grid.q.count: missing", "[1, 1e6]"}},
           {"[grid]\nq = { from = 2, to = 3, count = 0 }\n", {"s.toml:9: grid.q.count = 0: ", "[1, 1e6]"}},
           {"[grid]\nq = { from = 2, to = 3, count = 2.5 }\n", {"s.toml:9: grid.q.count = 2.5: ", "whole number"}},
           {"[grid]\nq = { from = 2, to = 3, count = 1 }\n", {"s.toml:9: grid.q.count = 1: ", "from = to"}},
           {"[grid]\nq = { from = 1, to = 3, count = 5 }\n", {"s.toml:9: grid.q.from = 1: ", "(1, 1e4]"}},
           {"[grid]\nq = { from = 2, to = 3, counts = 5 }\n",
            {"s.toml:9: grid.q.counts = 5: unknown key", "grid.q.count"}},
           {"[grid]\nq = { from = 2, to = 3, count = 5, spacing = \"lin\" }\n",
            {"s.toml:9: grid.q.spacing", "linear, log"}},
           {"[grid]\nsigma = { from = 0, to = 1, count = 5, spacing = \"log\" }\n",
            {"s.toml:9: grid.sigma.from", "from > 0"}},
           {"[grid]\nsigma = { from = 1, to = 0, count = 5, spacing = \"log\" }\n",
            {"s.toml:9: grid.sigma.to", "to > 0"}},
           {"[source]\n", {"s.toml:8: source.irradiance: missing", "[0, inf)", "source.preset, source.file"}},
           {"[source]\nscale = 2\n", {"s.toml:8: source.irradiance: missing"}},
           {"[source]\nirradiance = 1\npreset = \"sun\"\n",
            {"s.toml:10: source.preset", "combined with source.irradiance"}},
           {"[source]\nirradiance = -1\n", {"s.toml:9: source.irradiance = -1: ", "out of range", "[0, inf)"}},
           {"[source]\nfile = \"absent.csv\"\n",
            {"s.toml:9: source.file = \"absent.csv\": cannot be read: No such file"}},
           {"[source]\nfile = 3\n", {"s.toml:9: source.file = 3: must be a text"}},
           {"[surroundings]\n", {"s.toml:8: surroundings.temperature_K: missing", "[0, 1e4]"}},
           {"[path]\ntemperature_K = 3\nradiance = 1\n",
            {"s.toml:10: path.radiance = 1", "combined with path.temperature_K"}},
           {"[accuracy]\ntolerance = 0.1\n", {"s.toml:9: accuracy.tolerance = 0.1: ", "[1e-10, 0.01]"}},
           {"[accuracy]\ntolerance = nan\n", {"s.toml:9: accuracy.tolerance = ", "[1e-10, 0.01]"}},
           {"band_um = [8, 14]\n",
            {"s.toml:8: spectrum.band_um = [8, 14]: cannot be combined with spectrum.wavelength_um"}},
           {"[[grid]]\n", {"s.toml:8: grid", "must be a table"}},
           {"[surface]\n", {"s.toml:8: not valid TOML"}},
           {"title = \n", {"s.toml:8: not valid TOML"}},
           {"wavelength_um = 4\n", {"s.toml:8: not valid TOML"}},
           {"\n\n]\n", {"s.toml:10: not valid TOML"}},
           {"[grid]\nsigma = \"line\\nbreak\"\n", {"s.toml:9: grid.sigma = \"line break\": "}}}) {
    const std::string error = error_of(kMinimal + appended);
    for (const char* part : expected) EXPECT_TRUE(contains(error, part)) << appended;
    EXPECT_FALSE(contains(error, "\n"));
  }
}

TEST(SceneError_SomethingMissing, NamesTheLineOfItsTable) {
  const std::string rest = "[emission]\ntemperature_K = 300\n[spectrum]\nwavelength_um = 5\n";
  const std::string surface = "[surface]\nn = 1.5\nsigma = 0.3\n";
  for (const auto& [text, error] :
       {std::pair("\"surface.k\" = 0.1\n" + kMinimal, "surface.k: its dot is inside of quotes"),
        {"", "s.toml:1: surface.n: missing; must be a number in (0, 1e6]"},
        {rest + "[surface]\nsigma = 1\n", "s.toml:5: surface.n: missing"},
        {rest + "[surface]\nn = 1.5\n", "s.toml:5: surface.sigma: missing"},
        {rest + "[surface]\nsigma = 1\nk = 1\n", "s.toml:7: surface.k = 1: needs surface.n"},
        {surface + "[emission]\n[spectrum]\nwavelength_um = 5\n",
         "s.toml:4: emission.temperature_K: missing; must be a number in (0, 1e4]"},
        {surface + "[emission]\ntemperature_K = 300\n", "s.toml:1: spectrum.wavelength_um: missing"},
        {surface + "[spectrum]\nwavelength_um = 5\n", "s.toml:1: emission: missing; nothing radiates"},
        {"surface = 3\n", "s.toml:1: surface = 3: must be a table, [surface]"},
        {"title = 3\n" + kMinimal, "s.toml:1: title = 3: must be a text"}})
    EXPECT_TRUE(contains(error_of(text), error));
}

TEST(SceneError_KeysThatDoNotGoTogether, AreNamed) {
  const std::string no_emission = "surface.n = 1.5\nsurface.sigma = 0.3\nspectrum.wavelength_um = 5\n";
  EXPECT_TRUE(contains(error_of(no_emission + "source.relative_irradiance = 1\n"),
                       "s.toml:4: source.relative_irradiance = 1: needs the table [emission]"));
  EXPECT_EQ(error_of(no_emission + "source.irradiance = 1\n"), "no error");
  EXPECT_EQ(error_of(no_emission + "surroundings.temperature_K = 1\n"), "no error");
  EXPECT_TRUE(contains(error_of(kMinimal + "[surface.unused]\n"), "s.toml:8: surface.unused: unknown key"));
  const std::string grid = kMinimal + "[grid]\nq = [1.5, 2]\n";
  EXPECT_TRUE(contains(error_of(grid, {"surface.masking=smith"}), "s.toml:9: grid.q = [1.5, 2]: 1.5 is out of range"));
  EXPECT_TRUE(contains(error_of(grid, {"surface.masking=smith"}), "q in (1.5, 1e4]"));
  EXPECT_EQ(error_of(grid, {"surface.masking=smith", "surface.distribution=gaussian"}), "no error");
  EXPECT_TRUE(contains(error_of(kMinimal, {"surface.masking=smith", "surface.q=1.5"}), "--set surface.q=1.5: "));
}

TEST(SceneError_SeveralKeysThatDoNotGoTogether, AreNamedInOneMessage) {
  const std::string sea =
      "surface.n = 1.2\nsurface.sigma = 0.1\nsurface.masking = \"smith\"\nsurface.distribution = \"gaussian\"\n"
      "emission.temperature_K = 290\nemission.model = \"direct\"\nemission.bracket = true\n"
      "spectrum.wavelength_um = 10\n";
  EXPECT_EQ(error_of(kMinimal + "[grid]\nwind_m_s = 5\n"),
            "s.toml:9: grid.wind_m_s = 5: needs surface.distribution = \"gaussian\" and no surface.sigma beside it");
  EXPECT_EQ(error_of(kMinimal, {"surface.wind_m_s=5", "grid.sigma=1"}),
            "--set surface.wind_m_s=5: needs surface.distribution = \"gaussian\" and no grid.sigma beside it");
  EXPECT_EQ(error_of(sea, {"surface.scattering=multiple"}),
            "--set surface.scattering=multiple: needs surface.masking = \"v-cavity\" and emission.model = \"moments\" "
            "or \"fresnel\" and emission.bracket = false");
  EXPECT_EQ(error_of(sea, {"surface.scattering=multiple", "surface.masking=v-cavity", "emission.model=moments",
                           "emission.bracket=false", "surface.wind_m_s=5"}),
            "no error");
  EXPECT_EQ(error_of(sea, {"emission.model=fresnel", "geometry.mode=bistatic", "surface.masking=none"}),
            "s.toml:7: emission.bracket = true: needs surface.masking = \"smith\" or \"v-cavity\" and emission.model = "
            "\"moments\" or \"direct\" and geometry.mode = \"hemispherical\"");
  EXPECT_TRUE(contains(error_of(kMinimal, {"surface.masking=none", "emission.model=direct"}),
                       "needs surface.masking = \"smith\" or \"v-cavity\""));
  EXPECT_TRUE(contains(error_of(kMinimal, {"emission.bracket=yes"}), "true or false"));
}

TEST(SceneError_BandThatDoesNotAscend, IsRefused) {
  for (const char* band : {"[14, 8]", "[8, 8]", "[8]", "[8, 9, 10]", "8", "[8, nan]", "[0.01, 8]"}) {
    const std::string error = error_of(kMinimal, {std::string("spectrum.band_um=") + band});
    EXPECT_TRUE(contains(error, std::string("--set spectrum.band_um=") + band + ": "));
    EXPECT_TRUE(contains(error, "two ascending numbers in [0.1, 1e4]"));
  }
}

TEST(SceneError_FileThatCannotBeRead, IsAnInputError) {
  const auto error_of_path = [](const std::string& path) -> std::string {
    return error_text([&] { read_scene(path, {}); });
  };
  EXPECT_EQ(error_of_path("absent.toml"), "absent.toml: cannot be read: No such file or directory");
  EXPECT_EQ(error_of_path("/dev/zero"), "/dev/zero: is not a text: it holds a zero byte");
  EXPECT_EQ(error_of_path(kHostDir), kHostDir + ": cannot be read: Is a directory");
  const TemporaryFile empty("empty.toml", "");
  EXPECT_TRUE(contains(error_of_path(empty.path()), "empty.toml:1: surface.n: missing"));
}

TEST(SceneError_TooMuch, IsRefusedInOneShortLine) {
  const auto repeated = [](const std::string& text, std::size_t count) {
    std::string all;
    for (std::size_t i = 0; i < count; ++i) all += text;
    return all;
  };
  constexpr std::size_t kMany = 50'000;
  const std::string deep = "nested deeper than 100";
  EXPECT_EQ(error_of(kMinimal + repeated("a.", kMany) + "a = 1\n"), "s.toml:8: " + deep);
  EXPECT_EQ(error_of(kMinimal + '[' + repeated("'a' . ", kMany) + "a]\n"), "s.toml:8: " + deep);
  EXPECT_EQ(error_of(kMinimal + "a = " + repeated("{ a.a = [", 40)), "s.toml:8: " + deep);
  EXPECT_TRUE(error_of(kMinimal, {repeated("a.", kMany) + "a=1"}).ends_with("...: " + deep));
  EXPECT_TRUE(error_of(kMinimal, {"title={ " + repeated("a.", kMany) + "a=1}"}).ends_with("...: " + deep));
  EXPECT_TRUE(contains(error_of(kMinimal + std::string(kMany, 'a') + " = 1\n"), "s.toml:8: spectrum.aaa"));
  EXPECT_LT(error_of(kMinimal + std::string(kMany, 'a') + " = 1\n").size(), 300U);
  EXPECT_EQ(error_of(kMinimal + '#' + std::string(16U << 20U, ' ')), "s.toml: is longer than 16777216 bytes");
  EXPECT_TRUE(contains(error_of(kMinimal + "[grid]\nq = [" + repeated("2,", 1'000'001) + "]\n"),
                       "1000001 values; must be at most 1000000"));
}

TEST(SceneError_LongTextOfStrayBytes, IsCutAfterMostOfIt) {
  const std::string stray(200, '\xb9');
  EXPECT_EQ(one_line(stray), stray.substr(0, 77) + "...");
}

TEST(Scene_DotsThatNestNothing, AreAccepted) {
  const std::string dots(200, '.');
  parse("title = \"\"\"" + dots + "\\\"\n[[{\"\"\"  # " + dots + "\n" + kMinimal +
        "[grid]\ntheta_deg = [0.1, 0.2,\n0.3]\n");
  EXPECT_EQ(parse(kMinimal, {"title='" + dots + "'"}).title, dots);
}

TEST(SceneError_RandomBytes, IsAlwaysOneLineAndAlwaysAnInputError) {
  constexpr std::uint64_t kSeed = 20250804;
  constexpr int kTrials = 2000;
  std::cout << "seed " << kSeed << '\n';
  std::mt19937_64 random(kSeed);
  int refused = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::string text = kMinimal;
    for (int i = 0; i < 3; ++i) text[random() % text.size()] = static_cast<char>(random() % 256);
    const std::string error = error_of(text);
    EXPECT_FALSE(contains(error, "\n"));
    if (error != "no error") ++refused;
  }
  // Most scenes with three random bytes are invalid. A scene stays valid if the bytes only change digits or names.
  EXPECT_GT(refused, kTrials / 2);
}

// ---- Overrides -----------------------------------------------------------------------------------------------------

TEST(SceneOverride_Malformed, IsRefused) {
  for (const char* argument : {"surface.n", "=1", "surface..n=1", ".n=1", "surface.=1", ""}) {
    EXPECT_TRUE(error_of(kMinimal, {argument}).starts_with(std::string("--set ") + argument + ": must be KEY=VALUE"))
        << error_of(kMinimal, {argument});
  }
  EXPECT_TRUE(contains(error_of(kMinimal, {"surface.nn=1"}),
                       "--set surface.nn=1: unknown key; the nearest known key is surface.n"));
  EXPECT_TRUE(contains(error_of(kMinimal, {"grid.thta=1"}), "the nearest known key is grid.theta_deg"));
  EXPECT_TRUE(contains(error_of(kMinimal, {"surface.n.x=1"}), "--set surface.n.x=1: surface.n is not a table"));
  EXPECT_TRUE(contains(error_of(kMinimal, {"surface=3"}), "--set surface=3: must be a table, [surface]"));
  EXPECT_TRUE(contains(error_of(kMinimal, {"surface.n=1\nsurface.k=2"}), "must be a number"));
}

TEST(SceneKey_UnderAnotherUsualName, IsFoundByItsMeaning) {
  for (const auto& [name, key] : std::map<std::string, std::string>{
           {"source.zenith_deg", "grid.theta_deg (in bistatic mode theta is the zenith of the source"},
           {"source.azimuth_deg", "geometry.relative_azimuth_deg"},
           {"surface.roughness", "surface.sigma (a slope, not a height; the roughness alpha of GGX is sqrt(2) sigma)"},
           {"surface.alpha", "surface.sigma"},
           {"surface.RMS", "surface.sigma"},
           {"sigma", "surface.sigma"},
           {"surface.emissivity", "surface.n (the emissivity follows"},
           {"surface.refractive_index", "surface.n"},
           {"surface.ior", "surface.n"},
           {"surface.kappa", "surface.k"},
           {"surface.temperature_K", "emission.temperature_K"},
           {"sky.temperature_C", "surroundings"},
           {"path.temperature_k", "path.temperature_K"},
           {"wavelength", "spectrum.wavelength_um"},
           {"grid.wavelength_nm", "grid.wavelength_um"},
           {"geometry.angle_deg", "geometry.view_zenith_deg"},
           {"grid.incidence_deg", "grid.theta_deg"},
           {"surface.polarization", "surface.diffuse_polarisation"},
           {"surface.shadowing", "surface.masking"}}) {
    EXPECT_TRUE(contains(error_of(kMinimal, {name + "=1"}), "unknown key; the nearest known key is " + key));
  }
}

TEST(SceneWord_UnderAnotherUsualName, IsExplained) {
  for (const auto& [setting, hint] : std::map<std::string, std::string>{
           {"surface.distribution=ggx", "GGX is \"cauchy\" with surface.q = 2"},
           {"surface.distribution=Trowbridge-Reitz", "GGX is \"cauchy\" with surface.q = 2"},
           {"surface.distribution=beckmann", "Beckmann is \"gaussian\""},
           {"surface.masking=v-groove", "did you mean \"v-cavity\"?"},
           {"accuracy.precision=float64", "did you mean \"double\"?"}}) {
    const std::string message = error_of(kMinimal, {setting});
    EXPECT_TRUE(contains(message, "--set " + setting + ": must be one of ") && contains(message, hint)) << message;
  }
  EXPECT_TRUE(error_of(kMinimal, {"surface.masking=foo"}).ends_with("integral, smith"));
}

TEST(SceneText_WithoutQuotes, IsToldToNeedThem) {
  for (const auto& [text, word] : {std::pair("[surface]\nmasking = smith\n", "smith"),
                                   {"surface = { n = 1.5, masking = v-cavity }", "v-cavity"},
                                   {"surface.material = iron # a metal", "iron"},
                                   {"surface.material = gold (Ordal)\n", "gold (Ordal)"},
                                   {"grid.material = [iron, gold]\n", "iron"},
                                   {"source.file = /tmp/sun.csv", "/tmp/sun.csv"}})
    EXPECT_TRUE(error_of(text).ends_with(std::string("; a text needs quotes: \"") + word + '"')) << error_of(text);
  for (const char* text : {"surface.n = 1,5\n", "surface.n 1.5\n", "title = \"iron\n"})
    EXPECT_FALSE(contains(error_of(text), "needs quotes"));
  EXPECT_TRUE(contains(error_of(kMinimal, {"grid.material=[iron, gold]"}),
                       "--set grid.material=[iron, gold]: not valid TOML: "));
  EXPECT_TRUE(contains(error_of(kMinimal, {"surface.coating=[{material=PMMA, thickness_um=1}]"}),
                       "; a text needs quotes: \"PMMA\""));
  EXPECT_EQ(parse(kMinimal, {"title=[draft"}).title, "[draft");
}

TEST(SceneOverride_OfTheSky, TakesWhatBelongsToTheOldSkyAway) {
  const std::string sky =
      kMinimal + "[surroundings]\nprofile = \"clear-sky\"\nvapour_cm = 0.5\nair_temperature_K = 280\n";
  const SceneValues uniform = parse(sky, {"surroundings.temperature_K=250"});
  EXPECT_EQ(uniform.surroundings->temperature_K, 250.0);
  EXPECT_FALSE(uniform.surroundings->profile);
  EXPECT_TRUE(contains(error_of(sky, {"surroundings.temperature_K=250", "surroundings.vapour_cm=1"}),
                       "--set surroundings.vapour_cm=1: needs surroundings.profile"));
  TemporaryFile own("own_sky.csv", "zenith_deg,temperature_K\n0,200\n90,280\n");
  EXPECT_TRUE(contains(error_of(sky, {"surroundings.profile=" + own.path(), "surroundings.air_temperature_K=none"}),
                       own.path() +
                           ": surroundings.vapour_cm in the scene needs surroundings.profile = \"clear-sky\" or "
                           "\"overcast\"; surroundings.vapour_cm = none removes it"));
}

TEST(SceneOverride_OfAnAxis, IsNamedWhereItLacksAnEnd) {
  EXPECT_EQ(error_of(kMinimal + "[grid]\ntheta_deg = [0, 30]\n", {"grid.theta_deg={from=0, count=3}"}),
            "--set grid.theta_deg={from=0, count=3}: to: missing; must be a number in [0, 90]");
  const std::string axis = kMinimal + "[grid]\ntheta_deg = { from = 0, to = 30, count = 3 }\n";
  EXPECT_TRUE(contains(error_of(axis, {"grid.theta_deg.spacing=log"}), "--set grid.theta_deg.spacing=log: "));
}

TEST(SceneOverride_ThatTakesAnUnknownKeyAway, IsRefused) {
  const SceneValues scene = parse(kMinimal);
  for (const auto& [key, nearest] : {std::pair("surface.foo", "surface.n"), {"surroundngs", "surroundings"}}) {
    const std::string message = error_text([&] { with_settings(scene, {{key, {}}}); });
    EXPECT_EQ(message, fmt::format("{}: unknown key; the nearest known key is {}", key, nearest));
  }
  EXPECT_NO_THROW(with_settings(scene, {{"surface.k", {}}}));
}

TEST(SceneErrors_OfSeveralKeys, AreToldTogether) {
  const std::string error = error_of("surface.n = -1\nsurface.sgma = 0.3\nsurface.masking = \"deep\"\n", {});
  for (const char* part : {"s.toml:1: surface.n = -1: ", "; s.toml:3: surface.masking", "s.toml:2: surface.sgma"})
    EXPECT_TRUE(contains(error, part));
  const std::string missing = error_of("title = \"nothing\"\n", {});
  for (const char* part : {"surface.n: missing", "surface.sigma: missing", "spectrum.wavelength_um: missing"})
    EXPECT_TRUE(contains(missing, part));
  std::string many;
  for (int i = 0; i < 8; ++i) many += "surface.x" + std::to_string(i) + " = 1\n";
  EXPECT_TRUE(error_of(many, {}).ends_with("; and 3 more")) << error_of(many, {});
}

TEST(SceneError_OfAListForOneNumber, SaysWhereAListBelongs) {
  for (const auto& [setting, hint] :
       {std::pair("spectrum.wavelength_um=[8, 14]",
                  "; several values are grid.wavelength_um = [...]; a band is spectrum.band_um = [from, to]"),
        {"surface.sigma=[0.1, 0.2]", "must be a number in [0, 10]; several values are grid.sigma = [...]"},
        {"surface.specular=[0.1, 0.2]", "must be a number in [0, 1]"}})
    EXPECT_TRUE(error_of(kMinimal, {setting}).ends_with(hint)) << error_of(kMinimal, {setting});
}

TEST(SceneOverride_OfAnAlternative, ReplacesTheFilesChoice) {
  const SceneValues iron = parse(kMinimal, {"surface.material=iron"});
  EXPECT_EQ(iron.surface.material.name, "iron");
  const std::string with_iron =
      "surface.material = \"iron\"\nsurface.sigma = 0.3\nemission.temperature_K = 1\n"
      "spectrum.wavelength_um = 10.6\n";
  EXPECT_EQ(parse(with_iron, {"surface.n=1.4"}).surface.material.constant, (OpticalConstants{1.4, 0.0}));
  EXPECT_TRUE(contains(error_of(with_iron, {"surface.k=1"}), "--set surface.k=1: needs surface.n"));
  EXPECT_TRUE(contains(error_of(with_iron, {"surface.n=1.4", "surface.material=gold"}),
                       "--set surface.material=gold: cannot be combined with surface.n"));
  EXPECT_TRUE(parse(kMinimal, {"spectrum.band_um=[8, 14]"}).spectrum.is_band());
  const std::string gaussian = "surface.distribution=gaussian";
  const SceneValues sea = parse(kMinimal + "[grid]\nsigma = [0.1, 0.2]\n", {gaussian, "surface.wind_m_s=5"});
  EXPECT_EQ(sea.grid[Axis::kSigma].size(), 1U);
  // The later setting grid.sigma replaces the earlier wind speed. The scene keeps both settings in its list.
  const SceneValues changed = with_settings(sea, {{"grid.sigma", 0.4}});
  EXPECT_EQ(changed.grid[Axis::kSigma], std::vector<double>{0.4});
  EXPECT_TRUE(changed.wind_m_s.empty());
  EXPECT_EQ(changed.settings.size(), 2U);
}

TEST(SceneOverride_None, RemovesAnEffect) {
  const std::string text = kMinimal + "[surroundings]\ntemperature_K = 290\n";
  EXPECT_FALSE(parse(text, {"emission=none"}).emission);
  EXPECT_EQ(parse(text, {"emission=none", "emission.temperature_K=5"}).emission->temperature_K, 5.0);
  EXPECT_TRUE(contains(error_of(text, {"surface=none"}), "--set surface=none: must be a table"));
}

TEST(SceneOverride_ThatRemoves, IsReadFromItsText) {
  std::vector<std::string> keys = scene_tables();
  for (const Key& key : dolp::keys()) keys.push_back(key.key);
  for (const std::string& key : keys) {
    const std::string text = Setting{key, Value()}.text();
    EXPECT_TRUE(is_removal(Setting::from_text(text))) << text;
  }
  for (const char* text :
       {"surface.masking=none", "title=none", "surface.material=none", "surface.k=0", "surface=none"})
    EXPECT_FALSE(is_removal(Setting::from_text(text))) << text;
  EXPECT_EQ(parse(kMinimal + "[grid]\nsigma = [0.1, 0.2]\n", {"grid.sigma=none"}).grid[Axis::kSigma].size(), 1U);
  EXPECT_EQ(parse(kMinimal, {"title=a", "title={}"}).title, parse(kMinimal).title);
}

TEST(SceneOverride_Values, NeedNoQuotesAndKeepTheirSpelling) {
  EXPECT_EQ(parse(kMinimal, {"title=My scene # 1"}).title, "My scene # 1");
  EXPECT_EQ(parse(kMinimal, {"title=2.50"}).title, "2.50");
  EXPECT_EQ(parse(kMinimal, {"title=\"2.50\""}).title, "2.50");
  EXPECT_EQ(parse(kMinimal, {"surface.sigma=.5"}).surface.sigma, 0.5);
  EXPECT_EQ(parse(kMinimal, {" surface.sigma = 0.5 "}).surface.sigma, 0.5);
  EXPECT_EQ(parse(kMinimal, {"surface.sigma=0.5", "surface.sigma=0.6"}).surface.sigma, 0.6);
  EXPECT_EQ(parse(kMinimal, {"surroundings={ temperature_K = 7 }"}).surroundings->temperature_K, 7.0);
}

}  // namespace
}  // namespace dolp::scene_error_test
