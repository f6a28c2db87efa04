// Error bound of single scattering, as the summary of a run states it.
#include "run/estimates.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "fixed_precision.hpp"
#include "rough_metal.hpp"
#include "run/scene_run.hpp"
#include "scene/scene_reader.hpp"

namespace dolp {
namespace {

const std::string kScene = kRoughMetal + "[grid]\ntheta_deg = [30, 60]\n";
// Both models to 1e-3 each, against results that are better.
constexpr double kAccuracy = 2e-3;

using Overrides = std::vector<std::string>;

std::vector<PointResult> results_of(const Overrides& overrides) {
  const SceneValues scene = parse_scene(kScene, "s.toml", settings_from_text(overrides));
  FixedPrecision evaluator(Precision::kDouble);
  return evaluate_scene(scene, grid_entries(scene), evaluator, {});
}

std::optional<double> gap_of(const Overrides& overrides) {
  const SceneValues scene = parse_scene(kScene, "s.toml", settings_from_text(overrides));
  const SceneEntries entries = grid_entries(scene);
  return scattering_gap(scene, entries, plan_effects(scene, entries, false));
}

TEST(ScatteringGap, FewEntries_IsTheLargestDifferenceOfDolp) {
  for (const char* masking : {"surface.masking=v-cavity", "surface.masking=smith"}) {
    const std::vector<PointResult> kirchhoff = results_of({masking, "emission.model=moments"});
    const std::vector<PointResult> direct = results_of({masking, "emission.model=direct"});
    double largest = 0.0;
    for (std::size_t i = 0; i < direct.size(); ++i) {
      largest = std::fmax(largest, std::abs(direct[i][Quantity::kDolp] - kirchhoff[i][Quantity::kDolp]));
    }
    EXPECT_GT(largest, 0.05);
    for (const char* model : {"emission.model=moments", "emission.model=direct"}) {
      const std::optional<double> gap = gap_of({masking, model});
      ASSERT_TRUE(gap.has_value());
      EXPECT_NEAR(*gap, largest, kAccuracy) << masking << " " << model;
    }
  }
}

TEST(ScatteringGap, WhateverTheAccuracyOfTheScene_IsTheSame) {
  const std::optional<double> gap = gap_of({});
  ASSERT_TRUE(gap.has_value());
  EXPECT_EQ(gap, gap_of({"accuracy.tolerance=1e-9", "accuracy.precision=double"}));
  EXPECT_EQ(gap, gap_of({"emission.bracket=true"}));
}

TEST(ScatteringGap, Mirror_IsZero) { EXPECT_NEAR(gap_of({"surface.sigma=0"}).value(), 0.0, 1e-15); }

TEST(ScatteringGap, WhereNothingIsLeftToSay_NoValue) {
  const std::vector<Overrides> scenes = {
      {"surface.scattering=multiple"},    {"emission=none", "source.irradiance=1"},
      {"emission.model=fresnel"},         {"surface.masking=none"},
      {"surface.masking=integral"},       {"surface.specular=0"},
      {"surroundings.temperature_K=300"}, {"geometry.mode=bistatic", "source.relative_irradiance=0.5"}};
  for (const Overrides& scene : scenes) EXPECT_FALSE(gap_of(scene).has_value()) << scene.front();
}

TEST(ScatteringGap, ManyEntriesOfABand_LooksAtFew) {
  const Overrides many = {"spectrum.band_um=[8,12]", "surface.material=aluminium (Ordal)",
                          "grid.theta_deg={from=0,to=80,count=81}", "grid.sigma={from=0.1,to=0.5,count=100}"};
  const std::optional<double> gap = gap_of(many);
  ASSERT_TRUE(gap.has_value());
  EXPECT_GT(*gap, 0.05);
}

}  // namespace
}  // namespace dolp
