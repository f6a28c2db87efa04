// Slopes that differ along and across: what holds for every scene, and what scenes and points refuse.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <dolp/status.hpp>
#include "agreement.hpp"
#include "computed_scene.hpp"

namespace dolp::cross_slopes_test {
namespace {

using enum Quantity;

constexpr const char* kBrushed =
    "[surface]\nn = 1.18\nk = 0.07\ndistribution = \"gaussian\"\nmasking = \"v-cavity\"\nscattering = \"multiple\"\n"
    "sigma = 0.1\nsigma_cross = 0.2\n[emission]\ntemperature_K = 290\n[surroundings]\nprofile = \"clear-sky\"\n"
    "[spectrum]\nwavelength_um = 10.6\n[grid]\ntheta_deg = [0, 40, 75]\n";

SceneValues brushed(const std::vector<Setting>& settings = {}) { return parse_scene(kBrushed, "scene.toml", settings); }

TEST(CrossSlopes, EqualWidths_HaveTheBitsOfOneWidth) {
  const auto one = results_of(brushed({{"surface.sigma_cross", Value()}}));
  const auto equal = results_of(brushed({{"surface.sigma_cross", 0.1}, {"geometry.surface_azimuth_deg", 30.0}}));
  ASSERT_EQ(one.size(), equal.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    for (const Quantity quantity : {kDolp, kStokesI, kStokesQ, kStokesU, kRhoI, kErrorEstimate})
      EXPECT_EQ(one[i][quantity], equal[i][quantity]) << describe(quantity).name;
  }
}

TEST(CrossSlopes, Azimuth_TurnsUAndRepeatsAfterAHalfTurn) {
  for (const char* masking : {"none", "v-cavity"}) {
    const bool is_cavity = std::string(masking) == "v-cavity";
    const auto at = [&](double azimuth_deg) {
      return results_of(brushed({{"surface.masking", masking},
                                 {"surface.scattering", is_cavity ? "multiple" : "single"},
                                 {"geometry.surface_azimuth_deg", azimuth_deg}}));
    };
    const auto turned = at(35.0), back = at(-35.0), half = at(215.0), along = at(0.0), across = at(90.0);
    for (std::size_t i = 0; i < turned.size(); ++i) {
      for (const Quantity quantity : {kStokesI, kStokesQ, kRhoI, kRhoQ, kDolp}) {
        EXPECT_EQ(turned[i][quantity], back[i][quantity]);
        EXPECT_NEAR(turned[i][quantity], half[i][quantity], 1e-12 * std::abs(half[i][quantity]));
      }
      EXPECT_EQ(turned[i][kStokesU], -back[i][kStokesU]);
      EXPECT_NEAR(turned[i][kStokesU], half[i][kStokesU], 1e-12);
      EXPECT_EQ(along[i][kStokesU], 0.0);
      EXPECT_EQ(across[i][kStokesU], 0.0);
      if (i > 0) {
        EXPECT_GT(std::abs(turned[i][kStokesU]), 100.0 * turned[i][kErrorEstimate]);
      }
      EXPECT_NEAR(turned[i][kDolp], std::hypot(turned[i][kStokesQ], turned[i][kStokesU]) / turned[i][kStokesI], 1e-12);
    }
  }
}

// Seen from the zenith, the axes of brushed metal polarise: Q has opposite signs along and across the brush.
TEST(CrossSlopes, Zenith_IsPolarisedAlongTheAxes) {
  const auto at = [](double azimuth_deg) {
    return results_of(brushed({{"geometry.surface_azimuth_deg", azimuth_deg}})).front();
  };
  const PointResult along = at(0.0), across = at(90.0), between = at(45.0);
  const double error = between[kErrorEstimate] * between[kStokesI];
  EXPECT_NEAR(along[kStokesQ], -across[kStokesQ], 2.0 * error);
  EXPECT_GT(std::abs(along[kStokesQ]), 100.0 * error);
  EXPECT_NEAR(between[kStokesQ], 0.0, error);
}

TEST(CrossSlopes, DirectionalWind_HasTheWidthsOfCoxAndMunk) {
  const SceneValues scene = brushed({{"surface.sigma", Value()},
                                     {"surface.sigma_cross", Value()},
                                     {"surface.wind_model", "directional"},
                                     {"surface.wind_m_s", 10.0}});
  const SlopeShape shape = grid_entries(scene)[0].shape;
  EXPECT_NEAR(shape.sigma * shape.sigma, 0.0316, 1e-12);
  EXPECT_NEAR(shape.sigma_cross * shape.sigma_cross, 0.0222, 1e-12);
}

TEST(CrossSlopes, GridAndPoints_AgreeWithSingleScenes) {
  const SceneValues scene = brushed({{"grid.sigma_cross", std::vector{0.1, 0.15}},
                                     {"grid.surface_azimuth_deg", std::vector{0.0, 20.0}},
                                     {"grid.theta_deg", std::vector{60.0}}});
  const SceneEntries grid = grid_entries(scene);
  ASSERT_EQ(grid.size(), 4U);
  const auto table = results_of(scene);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const SlopeShape shape = grid[i].shape;
    const PointResult alone = results_of(brushed({{"surface.sigma_cross", shape.sigma_cross},
                                                  {"geometry.surface_azimuth_deg", shape.azimuth_deg},
                                                  {"grid.theta_deg", std::vector{60.0}}}))
                                  .front();
    expect_agreement(table[i], alone);
    EXPECT_NEAR(table[i][kRhoU], alone[kRhoU], 1e-4 * alone[kRhoI]);
  }
}

TEST(CrossSlopes, SourceOfAGrid_IsReflectedLikeThatOfPoints) {
  const std::vector<Setting> bistatic = {{"geometry.mode", "bistatic"},
                                         {"geometry.view_zenith_deg", 40.0},
                                         {"geometry.relative_azimuth_deg", 150.0},
                                         {"geometry.surface_azimuth_deg", 40.0},
                                         {"source.irradiance", 1e4}};
  const std::vector<std::vector<Setting>> cases = {
      {},
      {{"surface.masking", "none"}, {"surface.scattering", "single"}},
      {{"grid.sigma_cross", std::vector{0.1, 0.3}}, {"grid.sigma", std::vector{0.1, 0.2}}},
      {{"grid.surface_azimuth_deg", std::vector{0.0, 90.0}}, {"grid.relative_azimuth_deg", std::vector{90.0, 150.0}}},
      {{"surface.sigma", Value()},
       {"surface.sigma_cross", Value()},
       {"surface.wind_model", "directional"},
       {"surface.wind_m_s", 10.0}}};
  for (const std::vector<Setting>& changes : cases) {
    const SceneValues scene = brushed(joined(bistatic, changes));
    const SceneEntries grid = grid_entries(scene);
    std::vector<SceneEntry> points, round;
    for (const SceneEntry& entry : grid.all()) {
      points.push_back(entry);
      round.emplace_back(entry).shape.sigma_cross = 0.0;
    }
    CpuEvaluator evaluator;
    const auto table = results_of(scene);
    const auto list = evaluate_scene(scene, {points, grid.variants()}, evaluator, {});
    const auto isotropic = evaluate_scene(scene, {round, grid.variants()}, evaluator, {});
    ASSERT_EQ(table.size(), list.size());
    double largest = 0.0;
    for (std::size_t i = 0; i < table.size(); ++i) {
      EXPECT_NEAR(table[i][kStokesI], list[i][kStokesI], 1e-9 * list[i][kStokesI]);
      EXPECT_NEAR(table[i][kDolp], list[i][kDolp], table[i][kErrorEstimate] + list[i][kErrorEstimate]);
      largest = std::max(largest, std::abs(table[i][kStokesI] / isotropic[i][kStokesI] - 1.0));
    }
    EXPECT_GT(largest, 0.01);
  }
}

// Without masking, reflectances of heavy tails diverge at 90 degrees, and the limit of elliptic slopes is not known.
TEST(CrossSlopes, DivergentLimit_IsOutsideTheModel) {
  const PointResult limit = results_of(brushed({{"surface.distribution", "cauchy"},
                                                {"surface.q", 1.3},
                                                {"surface.masking", "none"},
                                                {"surface.scattering", "single"},
                                                {"grid.theta_deg", std::vector{90.0}}}))
                                .front();
  EXPECT_TRUE(std::isnan(limit[kDolp]));
  EXPECT_EQ(limit.status & kOutsideModelDomain, std::uint32_t{kOutsideModelDomain});
}

const std::vector<Setting> kSmithDirect = {{"surface.masking", "smith"},
                                           {"surface.scattering", "single"},
                                           {"emission.model", "direct"},
                                           {"surroundings", Value()}};

std::vector<Setting> smith_direct(const std::vector<Setting>& more) { return joined(kSmithDirect, more); }

// Only the direct emission is known: reflected light depends on the slopes in every direction.
TEST(CrossSlopes, SmithWithDirectEmission_GivesEmissivitiesAndNoReflectances) {
  const auto one = results_of(brushed(smith_direct({{"surface.sigma_cross", Value()}})));
  const auto equal = results_of(brushed(smith_direct({{"surface.sigma_cross", 0.1}})));
  const auto along_and_across = results_of(brushed(smith_direct({{"geometry.surface_azimuth_deg", 45.0}})));
  for (std::size_t i = 0; i < one.size(); ++i) {
    for (const Quantity quantity : {kDolp, kStokesI, kStokesQ, kEmissivityS, kErrorEstimate})
      EXPECT_EQ(one[i][quantity], equal[i][quantity]) << describe(quantity).name;
    const PointResult& result = along_and_across[i];
    for (const Quantity quantity : {kRhoI, kRhoQ, kRhoU, kAlbedo}) EXPECT_TRUE(std::isnan(result[quantity]));
    EXPECT_EQ(result.status, 0U);
    EXPECT_NE(result[kStokesU], 0.0);
    EXPECT_GT(result[kEmissivityP] + result[kEmissivityS], 1.0);
  }
}

TEST(CrossSlopes, ImpossibleScenes_AreRefusedWithTheirKeys) {
  const std::vector<std::pair<std::vector<Setting>, const char*>> cases = {
      {{{"surface.scattering", "single"}, {"surface.masking", "integral"}}, "surface.masking"},
      {{{"surface.scattering", "single"}, {"surface.masking", "smith"}}, "emission.model"},
      {smith_direct({{"surroundings.temperature_K", 250.0}}), "[surroundings]"},
      {{{"surface.sigma_cross", 2.0}}, "quotient of the widths"},
      {{{"surface.sigma", 0.0}}, "quotient of the widths"},
      {{{"surface.wind_model", "directional"}}, "surface.wind_m_s"}};
  for (const auto& [settings, part] : cases)
    EXPECT_TRUE(contains(error_text([&, own = settings] { grid_entries(brushed(own)); }), part));
  Points points;
  points.count = 1;
  points[Axis::kTheta] = {10.0};
  EXPECT_TRUE(contains(error_text([&] { point_entries(brushed({{"surface.sigma", 0.0}}), points); }), "quotient"));
}

}  // namespace
}  // namespace dolp::cross_slopes_test
