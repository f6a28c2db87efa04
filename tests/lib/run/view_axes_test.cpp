// Axes of view zenith and relative azimuth in bistatic mode, and the angle of polarisation.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "agreement.hpp"
#include "base/temporary_folder.hpp"
#include "computed_scene.hpp"
#include "radiometry/radiometry.hpp"
#include "run/prediction.hpp"
#include "run/table_run.hpp"
#include "table/table_file.hpp"
#include "verify/table_check.hpp"

namespace dolp::view_axes_test {
namespace {

using enum Quantity;

const std::string kScene = R"toml(
[surface]
n = 1.5
k = 0.1
sigma = 0.2
q = 3.0
masking = "smith"
diffuse = 0.05
[emission]
temperature_K = 300
[source]
irradiance = 2.0
[surroundings]
temperature_K = 250
[spectrum]
wavelength_um = 10
[geometry]
mode = "bistatic"
[grid]
view_zenith_deg = [0, 30, 62, 89]
relative_azimuth_deg = [-70, 0, 180]
theta_deg = [20, 62]
sigma = [0.1, 0.2]
)toml";
constexpr std::size_t kDirectionEntries = 2;  // one for each sigma

SceneValues scene_with(const std::vector<std::string>& overrides = {}) { return parse(kScene, overrides); }

double evaluations_of(const SceneValues& scene) {
  CpuEvaluator evaluator;
  evaluate_scene(scene, grid_entries(scene), evaluator, {});
  return evaluator.report().evaluations;
}

TEST(ViewAxes, Table_HasTheResultsOfEachGeometry) {
  for (const char* masking : {"smith", "integral", "v-cavity"}) {
    const std::string with_masking = std::string("surface.masking=") + masking;
    const SceneValues scene = scene_with({with_masking});
    const std::vector<PointResult> results = results_of(scene);
    ASSERT_EQ(results.size(), 4U * 3 * 2 * kDirectionEntries);
    std::size_t at = 0;
    for (const double view_deg : scene.grid[Axis::kViewZenith]) {
      for (const double azimuth_deg : scene.grid[Axis::kRelativeAzimuth]) {
        const std::vector<PointResult> right =
            results_of(scene_with({with_masking, "grid.view_zenith_deg=none", "grid.relative_azimuth_deg=none",
                                   fmt::format("geometry.view_zenith_deg={}", view_deg),
                                   fmt::format("geometry.relative_azimuth_deg={}", azimuth_deg)}));
        for (const PointResult& own : right) {
          const PointResult& result = results[at++];
          SCOPED_TRACE(fmt::format("{}, view {}, azimuth {}", masking, view_deg, azimuth_deg));
          const double bound = result[kErrorEstimate] + own[kErrorEstimate];
          expect_agreement(result, own);
          EXPECT_NEAR(result[kStokesU] / result[kStokesI], own[kStokesU] / own[kStokesI], bound);
          EXPECT_EQ(result.status, own.status);
        }
      }
    }
  }
}

TEST(ViewAxes, Columns_NameTheEntriesOfTheTable) {
  const SceneValues scene = scene_with();
  const std::string csv =
      "theta_deg,view_zenith_deg,relative_azimuth_deg,sigma\n20,0,0,0.1\n62,62,180,0.2\n20,89,-70,0.2\n";
  const std::vector<PointResult> results =
      results_of(scene, point_entries(scene, parse_points(csv, "p.csv", PointsKind::kDirections)));
  const TableValues table = table_of(scene);
  const std::vector<std::size_t> positions = {(0 * 3 + 1) * 4, (2 * 3 + 2) * 4 + 3, (3 * 3 + 0) * 4 + 1};
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double bound = results[i][kErrorEstimate] + table[kErrorEstimate][positions[i]];
    EXPECT_NEAR(results[i][kDolp], table[kDolp][positions[i]], bound) << i;
  }
  EXPECT_NE(results[1][kDolp], results[2][kDolp]);
}

TEST(ViewAxes, Moments_AreComputedOncePerViewZenith) {
  const double one = evaluations_of(scene_with({"grid.relative_azimuth_deg=0", "grid.theta_deg=20"}));
  EXPECT_GT(one, 0.0);
  EXPECT_EQ(evaluations_of(scene_with()), one);
}

TEST(ViewAxes, Shards_MergeToTheTable_WhichVerifies) {
  const TemporaryFolder folder;
  const SceneValues scene = scene_with();
  CpuEvaluator evaluator;
  std::vector<std::string> paths;
  for (std::size_t number = 1; number <= 6; ++number) {
    paths.push_back((folder.path() / fmt::format("{}.nc", number)).string());
    const TableJob job{.path = paths.back(), .shard = {number, 6}, .options = {}, .evaluator = "cpu"};
    write_table(scene, job, [&] { return &evaluator; });
  }
  const std::filesystem::path merged = folder.path() / "t.nc";
  EXPECT_EQ(ShardSet(paths).merge(merged, "test"), 48U);
  TableSample sample{read_table(merged), sample_positions(48, 48, 0)};
  EXPECT_EQ(sample.table.axes, scene.grid);
  EXPECT_EQ(sample.table[kDolp], table_of(scene)[kDolp]);
  EXPECT_TRUE(check_table(sample, scene, "t.nc", {}).passed());
  sample.table.axes[Axis::kRelativeAzimuth].back() = 150.0;
  EXPECT_FALSE(check_table(sample, scene, "t.nc", {}).passed());
}

TEST(ViewAxes, Prediction_CountsMomentsPerViewAndABeamPerEntry) {
  const SceneValues scene = scene_with();
  const RunPrediction run = predict_run(scene, grid_entries(scene), keep_everything(scene), true, [](const auto&) {});
  EXPECT_EQ(run.moments, 4U * kDirectionEntries);
  EXPECT_EQ(run.beams, 48U);
}

TEST(ViewAxes, ModeHemispherical_RefusesThem) {
  const std::string message = "grid.view_zenith_deg = [0, 30, 62, 89]: needs geometry.mode = \"bistatic\"";
  const std::string said = error_of(kScene, {"geometry.mode=hemispherical"});
  EXPECT_TRUE(contains(said, message)) << said;
  const SceneValues scene =
      scene_with({"geometry.mode=hemispherical", "grid.view_zenith_deg=none", "grid.relative_azimuth_deg=none"});
  const Points points = parse_points("theta_deg,view_zenith_deg\n30,8\n", "p.csv", PointsKind::kDirections);
  const std::string of_points = error_text([&] { point_entries(scene, points); });
  EXPECT_TRUE(contains(of_points, "column \"view_zenith_deg\" needs geometry.mode = \"bistatic\"")) << of_points;
}

TEST(ViewAxes, FirstValue_IsTheSceneGeometryUnlessTheSceneGivesOne) {
  EXPECT_EQ(scene_with({"grid.view_zenith_deg=[33, 44]"}).geometry.view_zenith_deg, 33.0);
  EXPECT_EQ(scene_with().geometry.relative_azimuth_deg, -70.0);
  EXPECT_EQ(scene_with({"geometry.view_zenith_deg=50"}).geometry.view_zenith_deg, 50.0);
}

// Rounding of atan2 and of the conversion to degrees.
constexpr double kAngleRounding_deg = 1e-12;

TEST(PolarisationAngle, Directions_AreThoseOfQAndU) {
  EXPECT_EQ(polarisation_angle_deg(2.0, 0.0), 0.0);
  EXPECT_EQ(polarisation_angle_deg(-2.0, 0.0), 90.0);
  EXPECT_EQ(polarisation_angle_deg(-2.0, -0.0), 90.0);
  EXPECT_NEAR(polarisation_angle_deg(0.0, 3.0), 45.0, kAngleRounding_deg);
  EXPECT_NEAR(polarisation_angle_deg(0.0, -3.0), 135.0, kAngleRounding_deg);
  EXPECT_EQ(polarisation_angle_deg(1.0, -1e-300), 0.0);
  EXPECT_TRUE(std::isnan(polarisation_angle_deg(0.0, 0.0)));
}

TEST(PolarisationAngle, Emission_IsP_AndOppositeAzimuthsMirrorIt) {
  std::size_t polarised = 0;
  for (const PointResult& result : results_of(scene_with({"source=none", "surroundings=none", "grid.theta_deg=0"}))) {
    const bool is_polarised = std::abs(result[kDolp]) > result[kErrorEstimate];
    EXPECT_EQ(result[kAolp], is_polarised ? 90.0 : polarisation_angle_deg(result[kStokesQ], 0.0));
    polarised += is_polarised ? 1 : 0;
  }
  EXPECT_EQ(polarised, 3U * 3 * kDirectionEntries);  // all but those at the normal
  const std::vector<PointResult> both = results_of(scene_with(
      {"grid.view_zenith_deg=40", "grid.relative_azimuth_deg=[-70, 70]", "grid.theta_deg=20", "grid.sigma=0.1"}));
  EXPECT_GT(both[0][kAolp], 0.0);
  EXPECT_NEAR(both[0][kAolp] + both[1][kAolp], 180.0, kAngleRounding_deg);
}

}  // namespace
}  // namespace dolp::view_axes_test
