// Estimates that a run makes from a few entries: the error of single scattering, and the effects of parts of a scene.
#include "run/estimates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <dolp/status.hpp>
#include <string>
#include <vector>

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "fixed_precision.hpp"
#include "rough_metal.hpp"
#include "run/scene_run.hpp"
#include "scene/scene_reader.hpp"

namespace dolp::estimates_test {
namespace {

const std::string kScene = kRoughMetal + "[grid]\ntheta_deg = [30, 60]\n";
// Two models are compared, and the result of each may have an error of 1e-3.
constexpr double kAccuracy = 2e-3;

using Overrides = std::vector<std::string>;

std::vector<PointResult> results_of(const Overrides& overrides) {
  const SceneValues scene = parse_scene(kScene, "s.toml", settings_from_text(overrides));
  FixedPrecision evaluator(Precision::kDouble);
  return evaluate_scene(scene, grid_entries(scene), evaluator, {});
}

std::optional<double> gap_of_scene(const SceneValues& scene) {
  const SceneEntries entries = grid_entries(scene);
  const std::optional<ScatteringGap> gap = scattering_gap(scene, entries, plan_effects(scene, entries, false));
  return gap ? std::optional(gap->dolp) : std::nullopt;
}
std::optional<double> gap_of(const Overrides& overrides) {
  return gap_of_scene(parse_scene(kScene, "s.toml", settings_from_text(overrides)));
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

TEST(ScatteringGap, NoEntries_NoValue) {
  const SceneValues scene = parse_scene(kScene, "s.toml", {});
  const SceneEntries none;
  EXPECT_FALSE(scattering_gap(scene, none, plan_effects(scene, none, false)).has_value());
}

TEST(ScatteringGap, WhereNothingIsLeftToSay_NoValue) {
  const std::vector<Overrides> scenes = {
      {"surface.scattering=multiple"},    {"emission=none", "source.irradiance=1"},
      {"emission.model=fresnel"},         {"surface.masking=none"},
      {"surface.masking=integral"},       {"surface.specular=0"},
      {"surroundings.temperature_K=300"}, {"geometry.mode=bistatic", "source.relative_irradiance=0.5"}};
  for (const Overrides& scene : scenes) EXPECT_FALSE(gap_of(scene).has_value()) << scene.front();
}

// Scenes over bands. Most of these materials need many spectral samples.
const std::vector<Overrides> kBandScenes = {
    {"surface.material=aluminium (Ordal)", "spectrum.band_um=[8,14]"},
    {"surface.material=water 25C", "spectrum.band_um=[3,5]", "surroundings.temperature_K=260"},
    {"surface.material=soda-lime glass", "spectrum.band_um=[7.5,12]", "surface.masking=smith"},
    {"surface.material=gold (Ordal)", "spectrum.band_um=[3,5]", "surface.distribution=cauchy"},
    {"surface.material=iron", "spectrum.band_um=[8,12]", "surroundings.profile=clear-sky"},
    {"surface.material=water 25C", "spectrum.band_um=[8,14]", "surroundings.profile=clear-sky",
     "surface.masking=smith"}};

SceneValues band_scene(Overrides overrides) {
  overrides.insert(overrides.begin(),
                   {"surface.n=none", "surface.k=none", "spectrum.wavelength_um=none",
                    "grid.theta_deg={from=0,to=85,count=12}", "grid.sigma=[0.1,0.02,0.25]", "grid.q=[2,3]"});
  SceneValues scene = parse_scene(kScene, "s.toml", settings_from_text(overrides));
  scene.accuracy.tolerance = 1e-3;
  return scene;
}

/// Largest difference of Q/I between two scenes over the whole grid.
double largest_change(const SceneValues& a, const SceneValues& b) {
  CpuEvaluator evaluator;
  const std::vector<PointResult> of_a = evaluate_scene(a, grid_entries(a), evaluator, {});
  const std::vector<PointResult> of_b = evaluate_scene(b, grid_entries(b), evaluator, {});
  double largest = 0.0;
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    if (!promises_dolp(of_a[i].status) || !promises_dolp(of_b[i].status)) continue;
    largest = std::max(largest, std::abs(of_a[i][Quantity::kQOverI] - of_b[i][Quantity::kQOverI]));
  }
  return largest;
}

TEST(ScatteringGap, Bands_IsWithinAFactorOfTwoOfTheDifferenceOfTwoTables) {
  for (const Overrides& overrides : kBandScenes) {
    const SceneValues kirchhoff = band_scene(overrides);
    SceneValues direct = kirchhoff;
    direct.emission->model = EmissionModel::kDirect;
    const double difference = largest_change(kirchhoff, direct);
    const std::optional<double> gap = gap_of_scene(kirchhoff);
    ASSERT_TRUE(gap.has_value()) << overrides.front();
    EXPECT_GT(*gap, 0.5 * difference) << overrides.front();
    EXPECT_LT(*gap, 2.0 * difference) << overrides.front();
  }
}

TEST(Influences, Bands_AreWithinAFactorOfTwoOfTheDifferenceOfTwoTables) {
  for (const Overrides& overrides : kBandScenes) {
    const SceneValues whole = band_scene(overrides);
    if (!whole.surroundings) continue;
    SceneValues without = whole;
    without.surroundings.reset();
    const double difference = largest_change(whole, without);
    const SceneEntries entries = grid_entries(whole);
    const EffectPlan plan = plan_effects(whole, entries, true);
    std::vector<Effect> effects = list_effects(whole, entries, plan);
    add_influences(effects, whole, entries, plan);
    const auto row = std::ranges::find(effects, Part::kSurroundings, &Effect::part);
    ASSERT_TRUE(row != effects.end() && row->influence.has_value()) << overrides.front();
    EXPECT_GT(*row->influence, 0.5 * difference) << overrides.front();
    EXPECT_LT(*row->influence, 2.0 * difference) << overrides.front();
  }
}

}  // namespace
}  // namespace dolp::estimates_test
