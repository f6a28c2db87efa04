// Polarised diffuse reflection in scenes: with a beam, under a sky, in Mueller matrices, and at equal temperatures.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "agreement.hpp"
#include "computed_scene.hpp"
#include "radiometry/diffuse.hpp"
#include "reference/reference_evaluator.hpp"
#include "run/mueller_run.hpp"
#include "temporary_file.hpp"

namespace dolp::diffuse_scenes_test {
namespace {

using enum Quantity;

const std::string kScene = R"toml(
[surface]
n = 1.5
k = 0.1
sigma = 0.3
q = 3.0
masking = "smith"
diffuse = 0.3
diffuse_exponent = -0.4
diffuse_polarisation = "transmission"
[emission]
temperature_K = 300
[spectrum]
wavelength_um = 10
[grid]
theta_deg = [60]
)toml";

SceneValues scene_with(const std::vector<std::string>& overrides) { return parse(kScene, overrides); }
PointResult result_of(const std::vector<std::string>& overrides) { return results_of(scene_with(overrides)).front(); }

TEST(DiffuseScenes, BistaticBeam_IsTheFirstColumnOfTheMuellerMatrix) {
  const std::vector<std::string> beam = {"emission=none", "source.irradiance=2", "geometry.mode=bistatic",
                                         "geometry.view_zenith_deg=40", "surface.specular=0.7"};
  const PointResult seen = result_of(beam);
  const SceneValues scene = scene_with(beam);
  CpuEvaluator evaluator;
  const Points points =
      parse_points("theta_i_deg,theta_r_deg,delta_phi_deg\n60,40,180\n", "p.csv", PointsKind::kGeometries);
  const MuellerMatrix f = evaluate_mueller(scene, mueller_points(scene, points), evaluator, {}).front();
  const double incident = 2.0 * std::cos(std::numbers::pi / 3.0);
  EXPECT_NEAR(seen[kStokesI], incident * f[0], 1e-5 * incident * f[0]);
  EXPECT_NEAR(seen[kStokesQ], incident * f[4], 1e-5 * incident * f[0]);
  // The diffuse part has f[0] f[5] = f[1] f[4]. The specular part does not, so the tolerance is wide.
  EXPECT_NEAR(f[0] * f[5], f[1] * f[4], 0.1);
}

TEST(DiffuseScenes, WithoutASpecularPart_TheMuellerMatrixIsAProduct) {
  const SceneValues scene = scene_with({"surface.specular=0"});
  CpuEvaluator evaluator;
  const Points points =
      parse_points("theta_i_deg,theta_r_deg,delta_phi_deg\n60,40,30\n40,60,30\n", "p.csv", PointsKind::kGeometries);
  const std::vector<MuellerMatrix> f = evaluate_mueller(scene, mueller_points(scene, points), evaluator, {});
  EXPECT_NEAR(f[0][0] * f[0][5], f[0][1] * f[0][4], 1e-16);
  EXPECT_NEAR(f[0][1], f[1][4], 1e-16);  // reciprocal
  EXPECT_LT(f[0][4], 0.0);
}

TEST(DiffuseScenes, EqualTemperatures_AreUnpolarised) {
  EXPECT_NEAR(result_of({"surroundings.temperature_K=300", "accuracy.tolerance=1e-6"})[kDolp], 0.0, 1e-12);
}

TEST(DiffuseScenes, SkyOfOneRadiance_IsThatOfItsTemperature) {
  const TemporaryFile sky("sky.csv", "zenith_deg,temperature_K\n0,240\n45,240.000001\n90,240\n");
  const PointResult profile = result_of({"surroundings.profile=" + sky.path()});
  const PointResult uniform = result_of({"surroundings.temperature_K=240"});
  EXPECT_NEAR(profile[kQOverI], uniform[kQOverI], 1e-5);
}

TEST(DiffuseScenes, SkyBrighterAtTheHorizon_AddsWhatTheDiffusePartSees) {
  const TemporaryFile sky("sky.csv", "zenith_deg,temperature_K\n0,200\n60,240\n90,300\n");
  const std::vector<std::string> scene = {"surface.specular=0", "surroundings.profile=" + sky.path()};
  const PointResult all = result_of(scene);
  // Radiance of the sky at 10 um by Planck's law. The diffuse part reflects the weighted mean of this radiance over all
  // zeniths, which is `mean` divided by `weights`.
  const auto radiance = [](double zenith_deg) {
    const double kelvin = zenith_deg < 60.0 ? 200.0 + zenith_deg / 60.0 * 40.0 : 240.0 + (zenith_deg - 60.0) * 2.0;
    return 1.191042972e8 / 1e5 / std::expm1(14387.76877 / (10.0 * kelvin));
  };
  const DiffuseReflection diffuse(scene_with(scene).surface, OpticalConstants{1.5, 0.1});
  double mean = 0.0, weights = 0.0;
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {
    const double zenith = (i + 0.5) / kSteps * std::numbers::pi / 2.0, cosine = std::cos(zenith);
    const double weight = std::pow(cosine, 0.6) * std::sin(zenith) * diffuse.transmitted(cosine).i;
    mean += weight * radiance(zenith * 180.0 / std::numbers::pi);
    weights += weight;
  }
  const DiffuseLight rho = diffuse.rho(0.5);
  const double emitted = 1.191042972e8 / 1e5 / std::expm1(14387.76877 / 3000.0);
  const double reflected = mean / weights;
  EXPECT_NEAR(all[kStokesI] / std::numbers::pi, emitted * (1.0 - rho.i) + reflected * rho.i, 1e-4 * emitted);
  EXPECT_NEAR(all[kStokesQ] / std::numbers::pi, (reflected - emitted) * rho.q, 1e-4 * emitted);
}

// Below the critical angle the body lets light through, beyond it none. The value comes from adaptive quadrature with
// 30 digits (mpmath), split at the critical angle, with the sky's formula evaluated at each zenith.
TEST(DiffuseScenes, TotalReflectionUnderALayeredSky_HasTheKinkAsAnEndOfThePanels) {
  constexpr double kQOverI0 = 0.00959910657358024;
  const SceneValues scene =
      scene_with({"surface.n=0.9", "surface.k=0", "surface.diffuse=1", "surface.specular=0",
                  "surface.diffuse_exponent=-0.3", "surroundings.profile=clear-sky", "surroundings.vapour_cm=0.5",
                  "spectrum.wavelength_um=3.4", "grid.theta_deg=[35]", "accuracy.tolerance=1e-6"});
  CpuEvaluator kernels;
  ReferenceEvaluator reference;
  for (ModelEvaluator* evaluator : std::initializer_list<ModelEvaluator*>{&kernels, &reference}) {
    const PointResult result = evaluate_scene(scene, grid_entries(scene), *evaluator, {}).front();
    EXPECT_NEAR(result[kQOverI], kQOverI0, result[kErrorEstimate]);
    EXPECT_LT(result[kErrorEstimate], 1e-9);
    EXPECT_EQ(result.status, 0U);
  }
}

TEST(DiffuseScenes, GridOfIndices_HasTheDiffusePartOfEach) {
  const SceneValues scene = scene_with({"grid.n=[1.3, 2.0, 4.0]", "grid.k=[0, 0.5]"});
  const SceneEntries entries = grid_entries(scene);
  const std::vector<PointResult> results = results_of(scene, entries);
  for (std::size_t i = 0; i < results.size(); ++i) {
    const OpticalConstants index = *entries[i].index;
    expect_agreement(results[i],
                     result_of({"surface.n=" + std::to_string(index.n), "surface.k=" + std::to_string(index.k)}));
  }
}

}  // namespace
}  // namespace dolp::diffuse_scenes_test
