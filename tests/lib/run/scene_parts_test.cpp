// Results in parts of a grid equal those in the whole grid bit for bit, however the grid is cut along its axes.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <tuple>

#include "draws.hpp"
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "run/scene_run.hpp"
#include "scene_run_support.hpp"
#include "table/table.hpp"

namespace dolp::scene_parts_test {
namespace {

using namespace scene_run_support;

std::unique_ptr<ModelEvaluator> evaluator_on(bool device) {
  if (device) return std::make_unique<VulkanEvaluator>(VulkanOptions{});
  return std::make_unique<CpuEvaluator>();
}

/// Computes a grid in parts, with a new evaluator that all parts share.
std::vector<PointResult> in_parts(const SceneValues& scene, const std::vector<SceneEntries>& parts, bool device) {
  const EffectPlan plan = keep_everything(scene);
  const SceneEntries whole = grid_entries(scene);
  CollectedResults results(whole);
  const auto evaluator = evaluator_on(device);
  for (const SceneEntries& part : parts) run_scene(scene, part, plan, evaluator.get(), {results.sink()});
  return results.take().list();
}

TEST(EntryReader, EntriesInTurn_AreThoseOfTheGrid) {
  Axes axes = make_axes({10.0, 20.0}, {0.1, 0.2}, {2.0, 3.0});
  axes[Axis::kSigmaCross] = {0.15, 0.25};
  axes[Axis::kSurfaceAzimuth] = {0.0, 45.0, 90.0};
  const SceneEntries grid = SceneEntries::grid(axes, {});
  EntryReader reader(grid);
  for (std::size_t i = 0; i < grid.size(); ++i) EXPECT_EQ(reader[i], grid[i]) << i;
}

TEST(ChosenEntries, OfAGrid_HaveTheWavelengthsAmongThemAlone) {
  Axes axes = make_axes({10.0, 20.0}, {0.1}, {2.0});
  axes[Axis::kWavelength] = {8.0, 9.0, 10.0, 11.0};
  const SceneEntries grid = SceneEntries::grid(axes, {});
  const std::vector<std::size_t> positions = {2, 3, 7};
  const SceneEntries chosen = grid.chosen(positions);
  EXPECT_EQ(chosen.variants().size(), 2U);  // the three entries have two wavelengths
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const SceneEntry whole = grid[positions[i]];
    EXPECT_EQ(chosen[i].theta_deg, whole.theta_deg);
    EXPECT_EQ(chosen.variants()[chosen[i].variant], grid.variants()[whole.variant]);
  }
}

TEST(PartsOfAList, KnowTheirPlaceInTheWhole) {
  const SceneEntries list = list_of(SceneEntries::grid({10.0, 20.0, 30.0, 40.0, 50.0}, {0.1}, {2.0}));
  const std::vector<SceneEntries> parts = list.parts(2);
  ASSERT_EQ(parts.size(), 3U);
  for (std::size_t part = 0; part < parts.size(); ++part) {
    EXPECT_EQ(parts[part].whole_size(), list.size());
    std::size_t found = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::optional<std::size_t> position = parts[part].find_position(i);
      EXPECT_EQ(position.has_value(), i / 2 == part);
      if (!position) continue;
      EXPECT_EQ(parts[part][*position].theta_deg, list[i].theta_deg);
      ++found;
    }
    EXPECT_EQ(found, parts[part].size());
    parts[part].for_each_run(list, [&](const GridRun& run) {
      EXPECT_EQ(run.in_part, 0U);
      EXPECT_EQ(run.in_whole, 2 * part);
      EXPECT_EQ(run.count, parts[part].size());
    });
  }
}

void expect_same_bits(const SceneValues& scene, bool device) {
  const SceneEntries grid = grid_entries(scene);
  const std::vector<PointResult> whole = in_parts(scene, {grid}, device);
  ASSERT_EQ(whole.size(), grid.size());
  for (const std::size_t most :
       {std::max(grid.size() / 3 + 1, grid.entries_per_direction()), grid.entries_per_direction()}) {
    const std::vector<PointResult> parts = in_parts(scene, grid.parts(most), device);
    ASSERT_EQ(parts.size(), whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i)
      ASSERT_EQ(bits_of(parts[i]), bits_of(whole[i])) << most << " at once: " << text_of(scene, grid[i]);
  }
}

class PartsOfModel : public testing::TestWithParam<std::tuple<Distribution, Masking>> {
 protected:
  SceneValues scene() const {
    SceneValues scene = make_scene(std::get<0>(GetParam()), std::get<1>(GetParam()), kAbsorbing);
    scene.accuracy.tolerance = 1e-4;
    return scene;
  }
  double least_q() const { return scene().surface.needs_mean_slope() ? 1.51 : 1.2; }
};

// Directions near 90 degrees need other quadrature nodes, and many entries with small q are computed again. The
// way in which the grid is cut into parts must not affect either.
TEST_P(PartsOfModel, InterpolatedGrid_KeepsItsBitsInParts) {
  SceneValues dense = scene();
  dense.grid =
      make_axes({90.0, 0.0, 85.0, 12.0, 89.95, 60.0, 30.0, 89.0}, spaced(1.0, 0.05, 30), spaced(least_q(), 6.0, 24));
  expect_same_bits(dense, true);
}

TEST_P(PartsOfModel, ScatteredAxes_KeepTheirBitsInParts) {
  SceneValues sparse = scene();
  sparse.grid =
      make_axes({70.0, 90.0, 20.0, 0.0, 89.999, 45.0, 88.0}, {0.3, 0.0, 2.0, 0.02}, {2.0, 8.0, least_q(), 1.9, 3.0});
  expect_same_bits(sparse, true);
  expect_same_bits(sparse, false);
}

TEST_P(PartsOfModel, AxesOfIndexAndWavelength_KeepTheirBitsInParts) {
  SceneValues own = scene();
  own.grid = make_axes({80.0, 30.0, 90.0}, {0.1, 0.4}, {2.0, 1.8, 5.0}, {8.0, 10.0}, {1.4, 4.0}, {0.0, 3.0});
  expect_same_bits(own, true);
}

// The entries of a list that have the same direction and index share work as in a grid, in whatever order they come.
TEST_P(PartsOfModel, ListOfAllEntriesOfAGrid_HasTheBitsOfTheGrid) {
  SceneValues sparse = scene();
  sparse.accuracy.may_interpolate = false;
  sparse.grid = make_axes({70.0, 20.0, 0.0, 45.0, 89.0}, {0.3, 2.0, 0.02}, {2.0, 3.0, least_q(), 8.0});
  const SceneEntries grid = grid_entries(sparse);
  std::vector<SceneEntry> list = list_of(grid);
  std::ranges::rotate(list, list.begin() + 7);
  const auto evaluator = evaluator_on(true);
  const std::vector<PointResult> expected = evaluate_scene(sparse, grid, *evaluator, {});
  const std::vector<PointResult> results = evaluate_scene(sparse, list, *evaluator, {});
  for (std::size_t i = 0; i < results.size(); ++i) {
    const std::size_t in_grid = (i + 7) % expected.size();
    EXPECT_EQ(bits_of(results[i]), bits_of(expected[in_grid])) << text_of(sparse, list[i]);
  }
}

INSTANTIATE_TEST_SUITE_P(SceneParts, PartsOfModel,
                         testing::Combine(testing::ValuesIn(kDistributions), testing::ValuesIn(kMaskings)));

// For a grid with many indices, the run computes integrals that do not depend on the index, called responses. From them
// it computes the moments of each index. It must use the same responses for a part of the grid as for the whole grid.
TEST(SceneParts, CombinedIndices_KeepTheirBitsInParts) {
  for (const Masking masking : {Masking::kVCavity, Masking::kIntegral}) {
    SceneValues scene = make_scene(Distribution::kCauchy, masking, kAbsorbing);
    scene.accuracy.tolerance = 1e-3;
    scene.grid = make_axes({80.0}, spaced(0.1, 0.4, 5), spaced(2.0, 5.0, 5), {}, spaced(1.3, 3.0, 8), {0.1, 0.9});
    const auto evaluator = evaluator_on(true);
    CollectedResults results(grid_entries(scene));
    const Work work =
        run_scene(scene, grid_entries(scene), keep_everything(scene), evaluator.get(), {results.sink()}).work;
    EXPECT_LT(2 * work.interpolation_nodes, work.interpolated);
    expect_same_bits(scene, true);
  }
}

TEST(SceneParts, AllBounces_KeepTheirBitsInParts) {
  SceneValues scene = make_scene(Distribution::kCauchy, Masking::kVCavity, kMetal);
  scene.surface.scattering = Scattering::kMultiple;
  scene.grid = make_axes({90.0, 0.0, 85.0}, spaced(0.05, 1.0, 3), spaced(1.3, 6.0, 3));
  expect_same_bits(scene, true);
}

TEST(SceneParts, ADenseBand_KeepsItsBitsInParts) {
  SceneValues scene = make_scene(Distribution::kCauchy, Masking::kVCavity, kAbsorbing);
  scene.surface.material.name = "made up";
  scene.surface.material.n = {{8.0, 14.0}, {1.4, 1.9}, SpectralTable::Interpolation::kLinear};
  scene.surface.material.k = {{8.0, 14.0}, {0.1, 0.8}, SpectralTable::Interpolation::kLinear};
  scene.spectrum = {8.0, 14.0};
  scene.grid = make_axes({90.0, 0.0, 85.0, 60.0, 30.0}, spaced(0.05, 1.0, 20), spaced(1.6, 6.0, 16));
  expect_same_bits(scene, true);
}

}  // namespace
}  // namespace dolp::scene_parts_test
