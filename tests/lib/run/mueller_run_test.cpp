// Mueller matrices of scenes: diffuse part, factor k_s, mirrors, directions at 90 degrees, precision and wavelength.
#include "run/mueller_run.hpp"
#include "error_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "reference/mueller.hpp"
#include "run/scene_run.hpp"

namespace dolp::mueller_run_test {
namespace {

const OpticalConstants kPaint{1.5, 0.1};

SceneValues scene_with(Masking masking) {
  SceneValues scene;
  scene.surface.masking = masking;
  scene.surface.sigma = 0.3;
  scene.surface.q = 3.0;
  scene.surface.material.constant = kPaint;
  scene.spectrum = {10.0, 10.0};
  scene.accuracy.precision = Precision::kDouble;
  return scene;
}

MuellerMatrix elements(const SceneValues& scene, const BeamAngles& angles, double sigma = 0.3) {
  CpuEvaluator evaluator;
  return evaluate_mueller(scene, {{angles, {sigma, 3.0}, kPaint}}, evaluator, {}).front();
}

bool is_all_nan(const MuellerMatrix& f) {
  return std::ranges::all_of(f, [](double m) { return std::isnan(m); });
}
bool is_finite(const MuellerMatrix& f) {
  return std::ranges::all_of(f, [](double m) { return std::isfinite(m); });
}

TEST(MuellerRun, SpecularAndDiffuse_AreAddedAsInEquation15) {
  SceneValues scene = scene_with(Masking::kIntegral);
  scene.surface.specular = 0.7;
  scene.surface.diffuse = 0.2;
  scene.surface.diffuse_exponent = -0.4;
  const BeamAngles angles{30.0, 55.0, 140.0};
  const MuellerMatrix f = elements(scene, angles);
  const double cosines = std::cos(std::numbers::pi / 6.0) * std::cos(55.0 * std::numbers::pi / 180.0);
  const reference::Slopes slopes(scene.surface.distribution, {scene.surface.sigma, scene.surface.q});
  const reference::Mueller specular = reference::single_bounce(slopes, Masking::kIntegral, kPaint, angles) / cosines;
  const double diffuse = 0.2 / std::numbers::pi * std::pow(cosines, -0.4);
  for (std::size_t i = 0; i < 16; ++i) {
    const double expected = 0.7 * specular.data()[i] + (i == 0 ? diffuse : 0.0);
    EXPECT_NEAR(f[i], expected, kScatteringError * specular(0, 0) + 1e-15) << i;
  }
}

TEST(MuellerRun, NinetyDegrees_IsTheLimitWhereThereIsOneAndNanElsewhere) {
  for (const BeamAngles& at : {BeamAngles{90.0, 40.0, 160.0}, BeamAngles{40.0, 90.0, 160.0}}) {
    for (const Masking masking : {Masking::kVCavity, Masking::kSmith}) {
      const MuellerMatrix f = elements(scene_with(masking), at);
      BeamAngles near = at;
      (at.theta_i_deg == 90.0 ? near.theta_i_deg : near.theta_r_deg) = 90.0 - 1e-6;
      const MuellerMatrix g = elements(scene_with(masking), near);
      EXPECT_GT(f[0], 0.0);
      for (std::size_t i = 0; i < 16; ++i)
        EXPECT_NEAR(f[i], g[i], 1e-6 * f[0]);  // `near` differs from `at` by 2e-8 rad
      SceneValues diffuse = scene_with(masking);
      diffuse.surface.diffuse = 0.1;
      EXPECT_TRUE(is_all_nan(elements(diffuse, at)));
      diffuse.surface.diffuse_exponent = 0.0;
      EXPECT_TRUE(is_finite(elements(diffuse, at)));
    }
    EXPECT_TRUE(is_all_nan(elements(scene_with(Masking::kNone), at)));
    EXPECT_TRUE(is_all_nan(elements(scene_with(Masking::kIntegral), at)));
  }
  for (const Masking masking : {Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith}) {
    EXPECT_TRUE(is_all_nan(elements(scene_with(masking), {90.0, 90.0, 160.0})));
  }
}

TEST(MuellerRun, Mirror_HasTheDiffusePartButInItsSpecularDirection) {
  SceneValues scene = scene_with(Masking::kIntegral);
  scene.surface.diffuse = 0.3;
  scene.surface.diffuse_exponent = 0.0;
  EXPECT_TRUE(is_all_nan(elements(scene, {40.0, 40.0, 180.0}, 0.0)));
  EXPECT_TRUE(is_all_nan(elements(scene, {40.0, 40.0, -180.0}, 0.0)));
  EXPECT_TRUE(is_all_nan(elements(scene, {0.0, 0.0, 33.0}, 0.0)));
  MuellerMatrix expected{};
  expected[0] = 0.3 / std::numbers::pi;
  EXPECT_EQ(elements(scene, {40.0, 41.0, 180.0}, 0.0), expected);
  EXPECT_EQ(elements(scene, {90.0, 40.0, 180.0}, 0.0), expected);
}

// With equal zeniths, light may bounce any number of times in a groove. An almost perfect conductor absorbs so little
// that more than 1,000 bounces contribute. With zeniths of 40 and 43 degrees, the number of bounces is
// limited. With a paint, absorption makes the later bounces negligible.
TEST(MuellerRun, MoreBouncesThanAreFollowed_AreNan) {
  SceneValues scene = scene_with(Masking::kVCavity);
  scene.surface.scattering = Scattering::kMultiple;
  CpuEvaluator evaluator;
  const auto at = [&](const BeamAngles& angles, const OpticalConstants& index) {
    return evaluate_mueller(scene, {{angles, {0.5, 1.6}, index}}, evaluator, {}).front();
  };
  EXPECT_TRUE(is_all_nan(at({40.0, 40.0, 100.0}, {1.0, 1e5})));
  EXPECT_TRUE(is_finite(at({40.0, 43.0, 100.0}, {1.0, 1e5})));
  EXPECT_TRUE(is_finite(at({40.0, 40.0, 100.0}, kPaint)));
}

TEST(MuellerRun, WithoutASpecularPart_OnlyTheDiffuseIsLeft) {
  SceneValues scene = scene_with(Masking::kNone);
  scene.surface.specular = 0.0;
  scene.surface.diffuse = 0.3;
  scene.surface.diffuse_exponent = 0.0;
  MuellerMatrix expected{};
  expected[0] = 0.3 / std::numbers::pi;
  EXPECT_EQ(elements(scene, {40.0, 90.0, 0.0}), expected);
  EXPECT_EQ(elements(scene, {40.0, 40.0, 180.0}, 0.0), expected);
}

TEST(MuellerRun, Error_IsATenthOfTheToleranceWithAllBounces) {
  SceneValues scene = scene_with(Masking::kVCavity);
  EXPECT_EQ(mueller_error(scene), kScatteringError);
  scene.surface.scattering = Scattering::kMultiple;
  for (const auto& [tolerance, error] : {std::pair{1e-2, 1e-5}, {1e-6, 1e-7}, {1e-12, kScatteringError}}) {
    scene.accuracy.tolerance = tolerance;
    EXPECT_DOUBLE_EQ(mueller_error(scene), error);
  }
}

std::string message_of(const SceneValues& scene, const std::string& csv) {
  return error_text([&] { mueller_points(scene, parse_points(csv, "p.csv", PointsKind::kGeometries)); });
}

TEST(MuellerPoints, MaterialOfAWavelength_IsThatOfTheScene) {
  SceneValues scene = scene_with(Masking::kNone);
  scene.path_name = "s.toml";
  scene.surface.material.name = "measured";
  scene.surface.material.n = {{8.0, 12.0}, {1.0, 3.0}, SpectralTable::Interpolation::kLinear};
  scene.surface.material.k = {{8.0, 12.0}, {0.2, 0.4}, SpectralTable::Interpolation::kLinear};
  const std::string csv = "theta_i_deg,theta_r_deg,delta_phi_deg,sigma\n10,20,30,0.5\n";
  const MuellerPoint point = mueller_points(scene, parse_points(csv, "p.csv", PointsKind::kGeometries)).front();
  EXPECT_DOUBLE_EQ(point.index.index.n, 2.0);
  EXPECT_DOUBLE_EQ(point.index.index.k, 0.3);
  EXPECT_EQ(point.shape.sigma, 0.5);
  EXPECT_EQ(point.shape.q, 3.0);
  EXPECT_EQ(point.angles.delta_phi_deg, 30.0);
  scene.spectrum = {8.0, 12.0};
  const std::string message = message_of(scene, csv);
  for (const char* part : {"s.toml", "band_um", "measured", "wavelength_um"}) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
  EXPECT_EQ(message_of(scene, "theta_i_deg,theta_r_deg,delta_phi_deg,n,k\n10,20,30,2,1\n"), "no error");
}

TEST(MuellerPoints, SmithBelowItsExponent_NamesTheLine) {
  const std::string message =
      message_of(scene_with(Masking::kSmith), "theta_i_deg,theta_r_deg,delta_phi_deg,q\n10,20,30,2\n10,20,30,1.5\n");
  for (const char* part : {"p.csv:3", "q = 1.5", "(1.5, 1e4]"}) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace dolp::mueller_run_test
