// A forecast recommends how many values each axis of a table needs for accurate lookups. The tests build such tables.
#include "run/lookup_run.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <dolp/status.hpp>
#include "draws.hpp"
#include "run/scene_table.hpp"
#include "scene_run_support.hpp"
#include "table/table_lookup.hpp"

namespace {

using namespace dolp;
using namespace scene_run_support;

constexpr double kTolerance = 1e-4;
constexpr int kPoints = 400;

SceneValues scene_with(Masking masking, std::size_t thetas, std::size_t sigmas, std::size_t qs) {
  SceneValues scene = make_scene(Distribution::kCauchy, masking, {1.5, 0.1});
  scene.grid[Axis::kTheta] = spaced(5.0, 80.0, thetas);
  scene.grid[Axis::kSigma] = spaced(0.1, 0.5, sigmas);
  scene.grid[Axis::kQ] = spaced(1.8, 6.0, qs);
  scene.accuracy.tolerance = kTolerance;
  return scene;
}

/// The share of random points that a lookup in a table of the scene's grid marks as inaccurate.
double flagged_share(const SceneValues& scene) {
  const SceneEntries grid = grid_entries(scene);
  const EffectPlan plan = keep_everything(scene);
  const TableValues table = table_part(table_layout(scene, plan, scene.grid), grid,
                                       evaluate_scene(scene, grid, *make_evaluator(Evaluator::kFloat), {}));
  const TableLookup lookup(table, scene, "table");
  std::mt19937_64 engine(3);
  const auto within = [&](const std::vector<double>& values) {
    return std::lerp(values.front(), values.back(), std::generate_canonical<double, 53>(engine));
  };
  int flagged = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double theta_deg = within(scene.grid[Axis::kTheta]), sigma = within(scene.grid[Axis::kSigma]),
                 q = within(scene.grid[Axis::kQ]);
    flagged += (lookup.at(theta_deg, sigma, q).status & kAnyToleranceNotMet) != 0 ? 1 : 0;
  }
  return static_cast<double>(flagged) / kPoints;
}

TEST(LookupForecast, TablesOfTheAdvisedDensity_AnswerMostPoints_AndHalfOfItTooFew) {
  for (const Masking masking : {Masking::kSmith, Masking::kVCavity, Masking::kIntegral}) {
    const SceneValues scene = scene_with(masking, 12, 9, 7);
    const std::vector<AxisForecast> axes = lookup_forecast(scene, keep_everything(scene)).axes;
    ASSERT_EQ(axes.size(), 3U);
    std::vector<std::size_t> counts;
    for (const AxisForecast& axis : axes) {
      EXPECT_LT(axis.wanted, kTolerance / 4.0);
      ASSERT_GE(axis.needed_values, 4U);
      counts.push_back(axis.needed_values);
    }
    EXPECT_LT(flagged_share(scene_with(masking, counts[0], counts[1], counts[2])), 0.2) << name_of(masking);
    EXPECT_GT(flagged_share(scene_with(masking, counts[0] / 2, counts[1] / 2, counts[2] / 2)), 0.5) << name_of(masking);
  }
}

TEST(LookupForecast, DenseAxis_NeedsFewerValues_AndOneOfThreeHasNoError) {
  SceneValues scene = scene_with(Masking::kVCavity, 200, 3, 1);
  scene.grid[Axis::kQ] = {3.0};
  const std::vector<AxisForecast> axes = lookup_forecast(scene, keep_everything(scene)).axes;
  ASSERT_EQ(axes.size(), 2U);
  EXPECT_EQ(axes[0].axis, Axis::kTheta);
  EXPECT_LT(axes[0].error, axes[0].wanted);
  EXPECT_LT(axes[0].needed_values, 60U);
  EXPECT_EQ(axes[1].axis, Axis::kSigma);
  EXPECT_TRUE(std::isinf(axes[1].error));
  EXPECT_GT(axes[1].needed_values, 3U);
}

// A forecast that may take no evaluations knows nothing, and one that may take some takes no more.
TEST(LookupForecast, FewEvaluationsAllowed_AreNotExceeded) {
  const SceneValues scene = scene_with(Masking::kSmith, 12, 9, 7);
  const EffectPlan plan = keep_everything(scene);
  const LookupForecast free = lookup_forecast(scene, plan);
  const double of_entry =
      2000.0;  // more than an entry of this scene takes on average, so that no step exceeds its bound
  for (const double share : {0.0, 0.2, 0.6}) {
    const double allowed = share * free.evaluations;
    const LookupForecast forecast = lookup_forecast(scene, plan, allowed, of_entry);
    EXPECT_LE(forecast.evaluations, allowed);
    ASSERT_EQ(forecast.axes.size(), free.axes.size());
    for (std::size_t i = 0; i < free.axes.size(); ++i) {
      const AxisForecast& axis = forecast.axes[i];
      EXPECT_TRUE(std::isnan(axis.error) || axis.error == free.axes[i].error);
      EXPECT_TRUE(axis.needed_values == 0 || axis.needed_values == free.axes[i].needed_values);
      EXPECT_LE(axis.examined, free.axes[i].examined);
      if (share == 0.0) {
        EXPECT_TRUE(std::isnan(axis.error) && axis.examined == 0);
      }
    }
  }
}

TEST(LookupForecast, FurtherAxes_AreLookedAtToo) {
  SceneValues scene = scene_with(Masking::kVCavity, 10, 5, 1);
  scene.grid[Axis::kQ] = {3.0};
  scene.grid[Axis::kN] = spaced(1.3, 2.0, 6);
  scene.grid[Axis::kWavelength] = spaced(9.0, 11.0, 5);
  const std::vector<AxisForecast> axes = lookup_forecast(scene, keep_everything(scene)).axes;
  ASSERT_EQ(axes.size(), 4U);
  for (const AxisForecast& axis : axes) EXPECT_TRUE(std::isfinite(axis.error));
}

}  // namespace
