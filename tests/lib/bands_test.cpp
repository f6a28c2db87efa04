// Bands over materials with total reflection inside, against integrals in 20 digits of the smooth surface.
#include <gtest/gtest.h>

#include <cmath>
#include <dolp/status.hpp>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "run/scene_run.hpp"
#include "scene/scene_reader.hpp"

namespace dolp {
namespace {

// Emission of a smooth surface at 300 K, 8-14 um. n rises evenly from 0.90 to 0.98, so that at each of these zeniths
// but the last total reflection ends inside of the band. DOLP by adaptive quadrature split there (mpmath, 20 digits).
struct Case {
  double theta_deg;
  double dolp;
};
constexpr Case kCases[] = {{66.0, 0.016512781153850004}, {70.0, 0.013142454651504826}, {75.0, 0.010722616002900640}};

SceneValues scene_with(const std::string& sigma, const std::string& tolerance) {
  const std::string path = std::filesystem::path(testing::TempDir()) / "rising_index.csv";
  std::ofstream(path) << "wavelength_um,n,k\n8,0.90,0\n14,0.98,0\n";
  return parse_scene(
      "[emission]\ntemperature_K = 300\n[spectrum]\nband_um = [8, 14]\n[surface]\nmasking = \"smith\"\nq = 3\n"
      "material_file = \"" +
          path + "\"\nsigma = " + sigma + "\n[accuracy]\ntolerance = " + tolerance + "\n",
      "s.toml", {});
}

TEST(Bands, TotalReflectionInsideOfAMirror_IsWithinItsEstimate) {
  constexpr double kRootError =
      5e-5;  // of the most panels; the estimate takes the worst place of a root among the nodes
  CpuEvaluator evaluator;
  for (const char* tolerance : {"1e-3", "1e-4"}) {
    const SceneValues scene = scene_with("0", tolerance);
    for (const Case& c : kCases) {
      const PointResult result = evaluate_scene(scene, {{c.theta_deg, {0.0, 3.0}, {}}}, evaluator, {}).front();
      EXPECT_LE(std::abs(result[Quantity::kDolp] - c.dolp), result[Quantity::kErrorEstimate]) << c.theta_deg;
      EXPECT_NEAR(result[Quantity::kDolp], c.dolp, kRootError) << c.theta_deg << ", tolerance " << tolerance;
    }
  }
}

TEST(Bands, TotalReflectionInsideOfANearMirror_TendsToTheMirror) {
  CpuEvaluator evaluator;
  const SceneValues scene = scene_with("0.0001", "1e-3");
  for (const Case& c : kCases) {
    const PointResult result = evaluate_scene(scene, {{c.theta_deg, {1e-4, 3.0}, {}}}, evaluator, {}).front();
    EXPECT_NEAR(result[Quantity::kDolp], c.dolp, result[Quantity::kErrorEstimate] + 1e-5) << c.theta_deg;
  }
}

}  // namespace
}  // namespace dolp
