// Whole runs at lists of points, and error messages about points. The order of the points changes no bit of a result.
#include "run/scene_run.hpp"

#include <gtest/gtest.h>

#include <iostream>
#include <numeric>
#include <random>

#include "agreement.hpp"
#include "error_text.hpp"
#include "scene_run_support.hpp"

namespace dolp::scene_run_test {
namespace {

using namespace scene_run_support;

constexpr unsigned kSeed = 20250811;

SceneValues small_grid(Distribution distribution, Masking masking) {
  SceneValues scene = make_scene(distribution, masking, kAbsorbing);
  scene.grid = make_axes({90.0, 0.0, 30.0, 75.0, 89.9}, {0.4, 0.0, 0.1}, {3.0, 1.6, 2.0});
  return scene;
}

/// A scene over a band, with a material whose n and k change with the wavelength.
SceneValues band_scene() {
  SceneValues scene = make_scene(Distribution::kCauchy, Masking::kNone, {});
  scene.surface.material.name = "made up";
  scene.surface.material.n = {{8.0, 11.0, 14.0}, {1.4, 1.9, 1.5}, SpectralTable::Interpolation::kLinear};
  scene.surface.material.k = {{8.0, 11.0, 14.0}, {0.1, 0.8, 0.2}, SpectralTable::Interpolation::kLinear};
  scene.spectrum = {8.0, 14.0};
  return scene;
}

TEST(PointEntries, Mistakes_AreToldWithFileLineColumnAndRange) {
  const SceneValues smith = make_scene(Distribution::kCauchy, Masking::kSmith, kDielectric);
  const SceneValues gaussian_smith = make_scene(Distribution::kGaussian, Masking::kSmith, kDielectric);
  const SceneValues integral = make_scene(Distribution::kCauchy, Masking::kIntegral, kDielectric);
  SceneValues two_zeniths = integral;
  two_zeniths.grid[Axis::kTheta] = {0.0, 60.0};
  SceneValues bracket = make_scene(Distribution::kCauchy, Masking::kVCavity, kDielectric);
  bracket.emission.emplace().has_bracket = true;
  struct Case {
    SceneValues scene;
    const char* csv;
    const char* message = "no error";
  };
  for (const Case& row : {
           Case{smith, "theta_deg,q\n10,1.501\n"},
           {gaussian_smith, "theta_deg,q\n10,1.2\n"},
           {integral, "theta_deg,q\n10,1.2\n"},
           {integral, "n\n1.7\n"},
           {band_scene(), "n,k\n1.5,0\n"},
           {smith, "theta_deg,q\n10,1.501\n20,1.5\n30,1.2\n",
            "p.csv:3: q = 1.5: out of range; must be a number in (1.5, 1e4] with masking = \"smith\" and distribution "
            "= "
            "\"cauchy\""},
           {bracket, "theta_deg,sigma_cross\n10,0.2\n",
            "p.csv:1: column \"sigma_cross\" needs emission.bracket = false in the scene"},
           {two_zeniths, "sigma\n0.2\n",
            "p.csv:1: column \"theta_deg\" is missing, a number in [0, 90]; only a scene with a single grid.theta_deg "
            "does without"},
           {band_scene(), "n\n1.5\n",
            "p.csv:1: column \"n\" needs column \"k\" beside it, because the scene's material \"made up\" depends on "
            "the wavelength"},
           {band_scene(), "k\n0.1\n",
            "p.csv:1: column \"k\" needs column \"n\" beside it, because the scene's material \"made up\" depends on "
            "the wavelength"},
       }) {
    const std::string error =
        error_text([&] { point_entries(row.scene, parse_points(row.csv, "p.csv", PointsKind::kDirections)); });
    EXPECT_EQ(error, row.message) << row.csv;
  }
}

TEST(PointEntries, AbsentColumns_ComeFromTheScene) {
  const SceneValues scene = make_scene(Distribution::kCauchy, Masking::kNone, kAbsorbing);
  const auto entries = point_entries(scene, parse_points("k,q\n0.25,4\n", "p.csv", PointsKind::kDirections));
  ASSERT_EQ(entries.size(), 1U);
  EXPECT_EQ(entries[0].theta_deg, 60.0);
  EXPECT_EQ(entries[0].shape, (SlopeShape{0.3, 4.0}));
  EXPECT_EQ(entries[0].index, (OpticalConstants{kAbsorbing.n, 0.25}));
}

TEST(PointEntries, AllCombinationsInTheOrderOfATable_AreAGrid) {
  const SceneValues scene = make_scene(Distribution::kCauchy, Masking::kNone, kAbsorbing);
  const std::vector<double> thetas = {50.0, 40.0, 30.0, 20.0}, sigmas = {0.1, 0.2, 0.3}, qs = {3.0, 4.0};
  const auto grid = [&](const std::vector<double>& theta_deg, const std::string& column = "", double last_q = 4.0) {
    std::string csv = "q,sigma,theta_deg" + (column.empty() ? "" : ',' + column);
    for (std::size_t i = 0; i < theta_deg.size() * 6; ++i) {
      const double q = i + 1 == theta_deg.size() * 6 ? last_q : qs[i % 2];
      csv += fmt::format("\n{},{},{}{}", q, sigmas[i / 2 % 3], theta_deg[i / 6], column.empty() ? "" : ",1.5");
    }
    const auto entries = point_entries(scene, parse_points(csv, "p.csv", PointsKind::kDirections));
    return entries.is_grid() ? std::optional(entries.axes()) : std::nullopt;
  };
  EXPECT_EQ(grid(thetas), make_axes(thetas, sigmas, qs));
  EXPECT_FALSE(grid({50.0, 40.0, 30.0})) << "too few to share integrals among the wavelengths of a grid";
  EXPECT_FALSE(grid({50.0, 40.0, 40.0, 30.0})) << "a zenith twice";
  EXPECT_FALSE(grid({50.0, 20.0, 40.0, 30.0})) << "not in order";
  EXPECT_FALSE(grid(thetas, "n")) << "lists share more among indices";
  EXPECT_FALSE(grid(thetas, "", 3.0)) << "not all combinations";
}

TEST(EvaluateScene_OwnIndexOfTheMaterial_GivesTheSameAsTheMaterial, OverABand) {
  SceneValues scene = band_scene();
  scene.surface.material = {};
  scene.surface.material.constant = kAbsorbing;
  const PointResult of_material = run_one(scene, 50.0, {0.3, 2.0}, Evaluator::kDouble);
  const SceneValues dispersive = band_scene();
  const PointResult of_point = run(dispersive, {{50.0, {0.3, 2.0}, kAbsorbing}}, Evaluator::kDouble).front();
  constexpr double kBandAgreement = 1e-9;  // accuracy of integrals over a band
  EXPECT_NEAR(of_point[Quantity::kDolp], of_material[Quantity::kDolp], kBandAgreement);
  EXPECT_NEAR(of_point[Quantity::kStokesI], of_material[Quantity::kStokesI],
              kBandAgreement * of_material[Quantity::kStokesI]);
}

class RunsOfModel : public testing::TestWithParam<std::tuple<Evaluator, Distribution, Masking>> {};

TEST_P(RunsOfModel, PermutedEntries_KeepTheirBits) {
  const auto [evaluator, distribution, masking] = GetParam();
  const SceneValues scene = small_grid(distribution, masking);
  std::vector<SceneEntry> entries = list_of(grid_entries(scene));
  for (const OpticalConstants& index : kIndices) entries.push_back({45.0, {0.2, 2.0}, index});
  const std::vector<PointResult> results = run(scene, entries, evaluator);
  std::vector<std::size_t> order(entries.size());
  std::iota(order.begin(), order.end(), 0U);
  std::cout << "seed " << kSeed << '\n';
  std::shuffle(order.begin(), order.end(), std::mt19937_64(kSeed));
  std::vector<SceneEntry> permuted;
  for (const std::size_t i : order) permuted.push_back(entries[i]);
  const std::vector<PointResult> again = run(scene, permuted, evaluator);
  for (std::size_t i = 0; i < order.size(); ++i) {
    EXPECT_EQ(bits_of(again[i]), bits_of(results[order[i]])) << text_of(scene, permuted[i]);
  }
}

// With some maskings, entries of a grid share intermediate sums, the slope samples. Then a grid agrees with separate
// points within the stated errors. With the other maskings, a grid agrees bit for bit.
TEST_P(RunsOfModel, Grid_EqualsThePointsOneByOne) {
  const auto [evaluator, distribution, masking] = GetParam();
  const bool has_slope_samples = masking == Masking::kNone || masking == Masking::kVCavity;
  const SceneValues scene = small_grid(distribution, masking);
  const SceneEntries entries = grid_entries(scene);
  std::vector<PointResult> results = run(scene, entries, evaluator);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    PointResult alone = run(scene, {entries[i]}, evaluator).front();
    // A grid interpolates the estimate behind this bit.
    for (PointResult* result : {&alone, &results[i]}) result->status &= ~kModelInaccurate;
    SCOPED_TRACE(text_of(scene, entries[i]));
    if (has_slope_samples) {
      expect_agreement(alone, results[i]);
      EXPECT_EQ(alone.status, results[i].status);
    } else {
      EXPECT_EQ(bits_of(alone), bits_of(results[i]));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(SceneRun, RunsOfModel,
                         testing::Combine(testing::ValuesIn(kPrecisions), testing::ValuesIn(kDistributions),
                                          testing::ValuesIn(kMaskings)));

}  // namespace
}  // namespace dolp::scene_run_test
