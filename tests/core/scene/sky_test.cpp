// Sky profiles: files, built-in skies, and interpolation over the zenith.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <dolp/errors.hpp>
#include <numbers>
#include <string>

#include "error_text.hpp"
#include "scene/scene_keys.hpp"
#include "scene/sky_profile.hpp"
#include "scene_support.hpp"
#include "spectrum/planck.hpp"
#include "spectrum/sky_factors.hpp"
#include "temporary_file.hpp"

namespace dolp::sky_test {
namespace {

std::string refusal_of(const std::string& text) {
  return error_text([&] { parse_sky_profile(text, "sky.csv"); });
}

TEST(SkyProfile, BadFile_IsOneLineThatNamesFileLineAndWhatIsAllowed) {
  for (const auto& [text, message] : {
           std::pair(
               "",
               "sky.csv:1: the file is empty; a line of column names is expected: zenith_deg, temperature_K, radiance "
               "(W m-2 sr-1 um-1), wavelength_um (or wavelength_nm, wavenumber_cm, energy_eV)"),
           {"zenith_deg,temperature_K\n", "sky.csv:1: no rows; zenith_deg from 0 to 90 is expected"},
           {"temperature_K\n200\n", "sky.csv:1: column \"zenith_deg\" is missing, a number in [0, 90]"},
           {"zenith_deg\n0\n",
            "sky.csv:1: needs one of the columns temperature_K, a number in [0, 1e4], and radiance, W m-2 sr-1 "
            "um-1"},
           {"zenith_deg,temperature_K,radiance\n0,1,1\n",
            "sky.csv:1: needs one of the columns temperature_K, a number in [0, 1e4], and radiance, W m-2 sr-1 "
            "um-1; both are there"},
           {"zenith_deg,height\n0,1\n",
            "sky.csv:1: column \"height\" is unknown; allowed are zenith_deg, temperature_K, radiance (W m-2 sr-1 "
            "um-1), wavelength_um (or wavelength_nm, wavenumber_cm, energy_eV)"},
           {"zenith_deg,temperature_K\n10,200\n90,250\n",
            "sky.csv:2: zenith_deg = 10: must be 0 in one row, and 90 in another"},
           {"zenith_deg,temperature_K\n0,200\n80,250\n", "sky.csv:3: zenith_deg = 80: must be 90 in one row"},
           {"zenith_deg,temperature_K\n0,200\n50,250\n90,270\n50,260\n",
            "sky.csv:5: zenith_deg = 50: is in line 3 too"},
           {"zenith_deg,temperature_K\n0,200\n95,250\n",
            "sky.csv:3: zenith_deg = 95: out of range; must be a number in [0, 90]"},
           {"zenith_deg,radiance\n0,-1\n90,1\n",
            "sky.csv:2: radiance = -1: out of range; must be a number in [0, inf)"},
           {"wavelength_um,zenith_deg,radiance\n8,0,1\n8,90,1\n9,0,1\n",
            "sky.csv:4: zenith_deg = 0: must be 90 in one row"},
           {"wavelength_um,zenith_deg,radiance\n8,0,1\n8,90,1\n9,0,1\n9,30,1\n9,90,1\n",
            "sky.csv:5: zenith_deg = 30: each wavelength must have the same angles, and the first has 90"},
       }) {
    EXPECT_EQ(refusal_of(text), message);
  }
}

TEST(SkyProfile, Text_ReadsBackAsTheSameProfile) {
  for (const char* text : {"zenith_deg,temperature_K\n0,220.5\n33.3,240\n90,288\n",
                           "wavelength_um,zenith_deg,radiance\n8,0,3.25\n8,90,9\n14,0,2\n14,90,7\n"})
    EXPECT_EQ(parse_sky_profile(text, "sky.csv").text(), text);
}

TEST(SkyProfile, RowsInAnyOrder_AreTheSameProfile) {
  const char* const sorted = "wavelength_um,zenith_deg,radiance\n8,0,1\n8,30,2\n8,90,3\n9,0,4\n9,30,5\n9,90,6\n";
  const char* const descending =
      "radiance,wavelength_um,zenith_deg\n6,9,90\n5,9,30\n4,9,0\n3,8,90\n2,8,30\n1,8,0\n,,\n";
  EXPECT_EQ(parse_sky_profile(descending, "s").text(), sorted);
}

TEST(SkyProfile, BetweenRows_IsAStraightLine) {
  const SkyProfile sky = parse_sky_profile("wavelength_um,zenith_deg,radiance\n8,0,2\n8,90,4\n10,0,6\n10,90,8\n", "s");
  EXPECT_DOUBLE_EQ(sky_radiance(sky, 8.0, 45.0), 3.0);
  EXPECT_DOUBLE_EQ(sky_radiance(sky, 9.0, 45.0), 5.0);
  EXPECT_DOUBLE_EQ(sky_radiance(sky, 10.0, 90.0), 8.0);
}

// Plane-parallel air has the radiance B (1 - t^(1 / cos(zenith))), with Planck's radiance B at the temperature of the
// air and the transmittance t at the zenith. Clouds are black bodies.
TEST(SkyProfile, BuiltInSkies_FollowTheirFormulas) {
  const double emissivity = 0.10 + 3.53e-8 * 7.85 * 7.85 * std::exp(3000.0 / 288.15);
  const SkyProfile clear = *built_in_sky("clear-sky");
  const SkyProfile overcast = *built_in_sky("overcast");
  const double air = planck_radiance(11.0, 288.15);
  EXPECT_NEAR(sky_radiance(clear, 11.0, 0.0) / air, emissivity, 1e-12);
  EXPECT_NEAR(sky_radiance(clear, 11.0, 60.0) / air, 1.0 - std::pow(1.0 - emissivity, 2.0), 1e-12);
  EXPECT_EQ(sky_radiance(clear, 11.0, 90.0), air);
  EXPECT_EQ(sky_radiance(clear, 4.3, 0.0), planck_radiance(4.3, 288.15));
  EXPECT_GT(sky_radiance(overcast, 11.0, 0.0), planck_radiance(11.0, 281.65));
  EXPECT_EQ(sky_radiance(overcast, 11.0, 90.0), air);
  EXPECT_FALSE(built_in_sky("cloudy"));
  for (const BuiltInSky& sky : built_in_skies()) EXPECT_TRUE(built_in_sky(sky.name)) << sky.name;
}

// mu is cos(zenith), from 0 to 1. Means over the sky have the weight mu^(c + 1). It is the product of the projected
// area, mu, and a reflectance, mu^c. With this weight the mean of mu^p is (c + 2) / (c + 2 + p).
TEST(SkyNodes, Means_OfPowersOfTheCosine_AreTheirClosedForms) {
  const SkyNodes nodes({0.0, 25.0, 60.0, 85.0, 90.0});
  for (const double c : {-0.9, -0.5, 0.0}) {
    for (const double p : {0.0, 1.0, 3.0}) {
      Eigen::VectorXd values(static_cast<Eigen::Index>(nodes.zenith_deg().size()));
      for (Eigen::Index i = 0; i < values.size(); ++i) {
        const double zenith_deg = nodes.zenith_deg()[static_cast<std::size_t>(i)];
        const double mu = zenith_deg == 90.0 ? 0.0 : std::cos(zenith_deg * std::numbers::pi / 180.0);
        values[i] = std::pow(mu, p);
      }
      EXPECT_NEAR(nodes.mean_weights(c).dot(values), (c + 2.0) / (c + 2.0 + p), 1e-10) << c << " " << p;
    }
  }
}

// w cm of precipitable water at T kelvin mean a vapour pressure of (w T / 46.5) hPa. Here w = 1 and T = 290. Idso's
// emittances are linear in `vapour`, the squared pressure times exp(3000 / T).
TEST(BuiltInSky, VapourAndTemperature_GiveTheEmittancesOfIdso) {
  const SkyProfile sky = *built_in_sky("clear-sky", {1.0, 290.0});
  const double vapour = std::pow(290.0 / 46.5, 2.0) * std::exp(3000.0 / 290.0);
  const double mean = 0.24 + 2.98e-8 * vapour, window = 0.10 + 3.53e-8 * vapour;
  EXPECT_NEAR(sky.at(11.5, 0.0).share, window, 1e-12);
  EXPECT_NEAR((2.0 * sky.at(11.5, 0.0).share + 4.0 * sky.at(9.0, 0.0).share) / 6.0, mean, 1e-12);
  EXPECT_NEAR(sky.at(13.5, 0.0).share, sky.at(9.0, 0.0).share, 1e-15);
  EXPECT_NEAR(sky.at(5.0, 0.0).share, mean, 1e-12);
  EXPECT_NEAR(sky.at(11.5, 60.0).share, 1.0 - std::pow(1.0 - window, 2.0), 1e-12);
  EXPECT_EQ(sky.at(11.5, 0.0).first_K, 290.0);
  EXPECT_EQ(sky.at(4.3, 0.0).share, 1.0);
  EXPECT_LT(built_in_sky("overcast", {1.0, 290.0})->at(11.5, 0.0).share, window);
}

// 7.85 hPa at 288.15 K are 46.5 * 7.85 / 288.15 cm of water.
TEST(BuiltInSky, DefaultsWrittenDown_GiveTheSameSky) {
  for (const char* name : {"clear-sky", "overcast"}) {
    const SkyProfile sky = *built_in_sky(name);
    for (const SkyAir& air : {SkyAir{{}, 288.15}, SkyAir{46.5 * 7.85 / 288.15, {}}, SkyAir{1.2668, 288.15}}) {
      const SkyProfile written = *built_in_sky(name, air);
      for (const double um : {4.0, 6.3, 9.0, 11.0, 15.0})
        EXPECT_NEAR(written.at(um, 30.0).share, sky.at(um, 30.0).share, 1e-5) << name << " at " << um;
    }
  }
}

TEST(BuiltInSky, MoreVapourThanTheAirHolds_IsRefused) {
  EXPECT_THROW(built_in_sky("clear-sky", {2.0, 273.15}), InputError);
  EXPECT_NO_THROW(built_in_sky("clear-sky", {1.0, 273.15}));  // air of 273.15 K holds at most 1.04 cm of water
  EXPECT_THROW(parse(kMinimal + "[surroundings]\ntemperature_K = 240\nvapour_cm = 1\n"), InputError);
}

TEST(SceneReader, Profile_TakesThePlaceOfATemperature) {
  const std::string sky = kMinimal + "[surroundings]\n";
  EXPECT_TRUE(parse(sky + "profile = \"overcast\"\n").surroundings->profile);
  EXPECT_TRUE(contains(error_of(sky + "profile = \"overcast\"\ntemperature_K = 250\n"), "cannot be combined with"));
  EXPECT_TRUE(contains(error_of(sky), "missing"));
  EXPECT_TRUE(contains(error_of(sky + "profile = \"cloudy\"\n"), "s.toml:9: surroundings.profile = \"cloudy\""));
}

TEST(SceneReader, TemperaturesOfZenithAndHorizon_AreTheProfileOfTwoRows) {
  const std::string sky = kMinimal + "[surroundings]\n";
  const std::string ends = sky + "zenith_temperature_K = 220\nhorizon_temperature_K = 285\n";
  const SceneValues scene = parse(ends);
  ASSERT_TRUE(scene.surroundings->profile);
  EXPECT_EQ(scene.surroundings->profile->text(), "zenith_deg,temperature_K\n0,220\n90,285\n");
  EXPECT_EQ(find_scene_key("surroundings.temperature_K")->value(scene), std::nullopt);
  const SceneValues uniform = parse(ends, {"surroundings.zenith_temperature_K=285"});
  EXPECT_FALSE(uniform.surroundings->profile);
  EXPECT_EQ(uniform.surroundings->temperature_K, 285.0);
  EXPECT_TRUE(contains(error_of(sky + "zenith_temperature_K = 220\n"), "needs surroundings.horizon_temperature_K"));
  EXPECT_TRUE(contains(error_of(sky + "horizon_temperature_K = 220\n"), "needs surroundings.zenith_temperature_K"));
  EXPECT_TRUE(contains(error_of(ends + "temperature_K = 250\n"), "cannot be combined with"));
  EXPECT_TRUE(contains(error_of(ends + "profile = \"overcast\"\n"), "cannot be combined with"));
}

// The profile lacks the scene's 10.6 um. It must be refused even if it has one temperature (250 K) everywhere.
TEST(SceneReader, ProfileKnownAtOtherWavelengths_IsRefused) {
  for (const std::string horizon_K : {"250", "260"}) {
    std::string rows = "wavelength_um,zenith_deg,temperature_K\n";
    for (const std::string um : {"3", "5"}) rows += um + ",0,250\n" + um + ",90," + horizon_K + '\n';
    const TemporaryFile file("sky.csv", rows);
    const std::string message = error_of(kMinimal + "[surroundings]\nprofile = \"" + file.path() + "\"\n");
    EXPECT_TRUE(message.ends_with("known at 3 to 5 um, and the spectrum is 10.6 um")) << message;
  }
}

TEST(SkyNodes, ErrorOfWideTemperatureRanges_HoldsBetweenTheNodes) {
  for (const auto& [cold_K, warm_K, wavelength_um] :
       {std::array{10.0, 2930.0, 22.0}, {3.0, 300.0, 10.0}, {50.0, 100.0, 1.0}, {10.0, 2930.0, 3.0}}) {
    const SkyNodes nodes({0.0, 60.0, 90.0});
    const auto radiance = [&](double zenith_deg) {
      return planck_radiance(wavelength_um, std::lerp(cold_K, warm_K, zenith_deg / 90.0));
    };
    Eigen::VectorXd values(static_cast<Eigen::Index>(nodes.zenith_deg().size()));
    std::ranges::transform(nodes.zenith_deg(), values.begin(), radiance);
    for (double zenith_deg = 0.05; zenith_deg < 90.0; zenith_deg += 0.1)
      EXPECT_LE(std::abs(nodes.at(zenith_deg, values)[0] - radiance(zenith_deg)),
                nodes.error(values) + 1e-14 * values.maxCoeff())
          << cold_K << " K, " << wavelength_um << " um, " << zenith_deg;
  }
}

}  // namespace
}  // namespace dolp::sky_test
