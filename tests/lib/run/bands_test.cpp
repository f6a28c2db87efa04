// Bands in which a material has total reflection at some wavelengths, compared with integrals in 20 digits.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "run/scene_run.hpp"
#include "run/scene_table.hpp"
#include "scene/scene_reader.hpp"
#include "verify/table_check.hpp"

namespace dolp::bands_test {
namespace {

// DOLP of the emission of a smooth surface at 300 K in the band from 8 to 14 um, where n rises linearly from 0.90 to
// 0.98. At each zenith, total reflection ends at a wavelength in the band. The values come from adaptive quadrature
// with 20 digits (mpmath), split at this wavelength.
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

TEST(Bands, TotalReflectionInsideOfAMirror_IsWithinItsEstimateAndTheTolerance) {
  CpuEvaluator evaluator;
  for (const char* tolerance : {"1e-3", "1e-4"}) {
    const SceneValues scene = scene_with("0", tolerance);
    for (const Case& c : kCases) {
      const PointResult result = evaluate_scene(scene, {{c.theta_deg, {0.0, 3.0}, {}}}, evaluator, {}).front();
      EXPECT_LE(std::abs(result[Quantity::kDolp] - c.dolp), result[Quantity::kErrorEstimate]) << c.theta_deg;
      EXPECT_EQ(result.status, 0u) << c.theta_deg << ", tolerance " << tolerance;
    }
  }
}

TEST(Bands, GlassWhoseIndexPassesOneNearGrazing_IsWithinItsEstimate) {
  const SceneValues scene = parse_scene(
      "[emission]\ntemperature_K = 300\n[surroundings]\ntemperature_K = 240\n[spectrum]\nband_um = [7.5, 9.5]\n"
      "[surface]\nmaterial = \"soda-lime glass\"\nsigma = 0\n",
      "s.toml", {});
  CpuEvaluator evaluator;
  const PointResult result = evaluate_scene(scene, {{85.0, {0.0, 2.0}, {}}}, evaluator, {}).front();
  constexpr double kDolp = 0.079003580827;  // by adaptive quadrature, to 12 decimals
  EXPECT_NEAR(result[Quantity::kDolp], kDolp, result[Quantity::kErrorEstimate] + 1e-12);
}

// The check computes at most a fiftieth of the moments again, and an entry of a band has one per spectral sample.
TEST(Bands, SelfCheck_CountsTheSamplesOfAnEntry) {
  const SceneValues scene = scene_with("0.2", "1e-2");
  std::vector<double> theta_deg;
  for (int i = 0; i < 40; ++i) theta_deg.push_back(2.0 * i);
  const SceneEntries grid = SceneEntries::grid(theta_deg, {0.2}, {3.0});
  const std::size_t samples = with_spectra(keep_everything(scene), scene, grid).rules->most_samples(grid);
  ASSERT_GT(checked_count(grid.size() * samples), 0U);
  CpuEvaluator evaluator;
  CollectedResults results(grid);
  const SelfCheck check = run_scene(scene, grid, keep_everything(scene), &evaluator, {results.sink()}).check;
  EXPECT_LE(50 * check.entries, grid.size());
}

/// Checks a table of a smooth surface against the reference. `dolp` replaces the DOLP of the first entry.
TableCheck check_with(std::optional<double> dolp) {
  SceneValues scene = scene_with("0", "1e-4");
  scene.grid[Axis::kTheta] = {66.0, 70.0, 75.0};
  scene.grid[Axis::kSigma] = {0.0};
  scene.grid[Axis::kQ] = {3.0};
  CpuEvaluator evaluator;
  const SceneEntries grid = grid_entries(scene);
  CollectedResults results(grid);
  run_scene(scene, grid, keep_everything(scene), &evaluator, {results.sink()});
  TableValues table = table_part(table_layout(scene, keep_everything(scene), scene.grid), grid, results.take());
  if (dolp) table[Quantity::kDolp][0] = *dolp;
  return check_table({std::move(table), {0, 1, 2}}, scene, "bands", {});
}

TEST(Bands, Verify_SeesAnErrorOfTheSpectralRule) {
  constexpr double kFewNodes = 0.0178396;  // wrong DOLP, from a spectral rule with too few nodes
  const TableCheck right = check_with({});
  for (const CheckedValue& failure : right.failures) ADD_FAILURE() << failure.quantity << ": " << failure.complaint;
  const TableCheck wrong = check_with(kFewNodes);
  ASSERT_EQ(wrong.failures.size(), 1u);
  EXPECT_NEAR(wrong.failures.front().reference, kCases[0].dolp, 1e-6);
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
}  // namespace dolp::bands_test
