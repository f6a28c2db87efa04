// The status bit 32, for entries where single scattering is not accurate enough.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <dolp/status.hpp>
#include <string>
#include <vector>

#include "computed_scene.hpp"
#include "run/estimates.hpp"

namespace dolp {
namespace {

using enum Quantity;
using Overrides = std::vector<std::string>;

const std::string kScene = R"toml(
[surface]
material = "aluminium (Ordal)"
sigma = 0.2
q = 3.0
[emission]
temperature_K = 300.0
[spectrum]
wavelength_um = 10.6
[grid]
theta_deg = [60]
)toml";

SceneValues scene_with(const Overrides& overrides) { return parse(kScene, overrides); }
PointResult result_of(const Overrides& overrides) { return results_of(scene_with(overrides)).front(); }

TEST(ModelChange, RoughMetalWithAnyMasking_HasBit32UnlessAllBouncesAreFollowed) {
  for (const char* masking : {"none", "v-cavity", "integral", "smith"}) {
    const PointResult result = result_of({std::string("surface.masking=") + masking});
    EXPECT_EQ(result.status & (kModelInaccurate | kToleranceNotMet), kModelInaccurate) << masking;
    EXPECT_GT(result.model_change, 0.05) << masking;
  }
  const PointResult all = result_of({"surface.masking=v-cavity", "surface.scattering=multiple"});
  EXPECT_EQ(all.status, 0U);
  EXPECT_EQ(all.model_change, 0.0);
  // Section "Limits" of README.md has these values of DOLP.
  EXPECT_NEAR(result_of({"surface.masking=integral"})[kDolp], 0.154, 5e-4);
  EXPECT_NEAR(result_of({"surface.masking=smith"})[kDolp], 0.108, 5e-4);
  EXPECT_NEAR(all[kDolp], 0.519, 5e-4);
}

TEST(ModelChange, SmoothPaint_HasNoBit) {
  const PointResult result = result_of({"surface.material={}", "surface.n=1.5", "surface.k=0.1", "surface.sigma=0.05"});
  EXPECT_EQ(result.status, 0U);
  EXPECT_LT(result.model_change, 0.01);
}

TEST(ModelChange, EmissionAndSurroundings_IsTheLostLightTimesTheDifferenceOfTheirRadiation) {
  const Overrides cases[] = {{"surface.masking=smith"},
                             {"surface.masking=integral", "surroundings.temperature_K=250"},
                             {"surface.masking=none", "surroundings.temperature_K=280", "surface.specular=0.6"}};
  for (Overrides overrides : cases) {
    const PointResult result = result_of(overrides);
    // With n = 1 and k = 0 the surface reflects nothing, so I is the radiation of a black body.
    overrides.insert(overrides.end(), {"surface.material={}", "surface.n=1", "surface.k=0"});
    const double emitted = result_of(overrides)[kStokesI];
    ASSERT_GT(emitted, 0.0);
    // I = emitted + rho_i (surroundings - emitted). `excess` is the difference in brackets.
    const double excess = (result[kStokesI] - emitted) / result[kRhoI];
    const double lost = (1.0 / result[kAlbedo] - 1.0) * result[kRhoI];
    EXPECT_NEAR(result.model_change, std::abs(lost * excess) / result[kStokesI], 1e-5 * result.model_change);
  }
}

TEST(ModelChange, TemperatureOfTheSurroundings_IsZeroWhereItIsThatOfTheSurface) {
  EXPECT_EQ(result_of({"surroundings.temperature_K=300"}).status & kModelInaccurate, 0U);
}

TEST(ModelChange, DirectEmission_IsWhatIsNeitherEmittedNorReflected) {
  const PointResult result = result_of({"surface.masking=smith", "emission.model=direct"});
  const double emissivity = 0.5 * (result[kEmissivityS] + result[kEmissivityP]);
  EXPECT_NEAR(result.model_change, (1.0 - result[kRhoI] - emissivity) / emissivity, 1e-3);
  EXPECT_NE(result.status & kModelInaccurate, 0U);
}

TEST(ModelChange, Estimate_IsThatOfTheLargestEntry) {
  const SceneValues scene = scene_with({"grid.theta_deg={from=0,to=80,count=33}", "grid.sigma=[0.02,0.1,0.3]"});
  CpuEvaluator evaluator;
  double largest = 0.0;
  for (const PointResult& result : evaluate_scene(scene, grid_entries(scene), evaluator, {})) {
    if (promises_dolp(result.status)) largest = std::max(largest, result.model_change);
  }
  std::vector<Effect> none;
  const double estimate = add_influences(none, scene, grid_entries(scene), keep_everything(scene)).model_change;
  EXPECT_GT(estimate, 0.5 * largest);
  EXPECT_LE(estimate, 1.01 * largest);
}

}  // namespace
}  // namespace dolp
