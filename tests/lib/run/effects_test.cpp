// Effects that a plan drops. Results with and without these effects must agree within the stated errors.
#include <gtest/gtest.h>

#include <iostream>
#include <map>

#include <dolp/status.hpp>
#include "draws.hpp"
#include "effects_support.hpp"
#include "scene/scene_reader.hpp"

namespace dolp::effects_test {
namespace {

using namespace effects_support;

constexpr std::uint64_t kSeed = 20250901;
/// Parts of a scene for which the plan gives a bound of their effect on DOLP. The bound is finite and above 0.
constexpr std::array kBounded = {Part::kSource, Part::kSurroundings, Part::kEmission, Part::kPathRadiance};
// Rounding error of a quotient of two sums of Stokes parameters.
constexpr double kRounding = 1e-11;

TEST(Dropping, RandomScenes_TheAnswerWithEverythingIsWithinTheEstimates) {
  std::cout << "seed " << kSeed << '\n';
  RandomScenes scenes(kSeed);
  std::map<Part, int> dropped;
  int without_moments = 0;
  for (std::size_t i = 0; i < draws_wanted(400); ++i) {
    const SceneValues scene = scenes.next();
    const std::vector<SceneEntry> entries = scenes.entries(scene);
    const EffectPlan plan = plan_effects(scene, entries, false);
    EXPECT_LE(plan.bound, kDroppedShare * scene.accuracy.tolerance);
    if (plan.dropped.empty() && plan.kept.moments) continue;
    for (const auto& [part, bound] : plan.dropped) ++dropped[part];
    without_moments += plan.kept.moments ? 0 : 1;
    const std::vector<PointResult> whole = run(scene, entries, keep_everything(scene));
    const std::vector<PointResult> left = run(scene, entries, plan);
    for (std::size_t j = 0; j < entries.size(); ++j) {
      const PointResult& a = whole[j];
      const PointResult& b = left[j];
      const std::string name =
          scene_text(scene, entries[j]) + "; " + effects_text(list_effects(scene, entries, plan), plan);
      if ((a.status & kOutsideModelDomain) != 0) {
        EXPECT_EQ(std::isnan(a[Quantity::kStokesI]), std::isnan(b[Quantity::kStokesI])) << name;
        continue;
      }
      if (!promises_dolp(a.status)) continue;
      EXPECT_EQ(b.status & kNoDolpPromised, 0U) << name;
      EXPECT_LE(std::abs(a[Quantity::kDolp] - b[Quantity::kDolp]),
                a[Quantity::kErrorEstimate] + b[Quantity::kErrorEstimate])
          << name;
      EXPECT_GE(b[Quantity::kErrorEstimate], plan.bound) << name;
      const bool is_missed = (b.status & kAnyToleranceNotMet) != 0;
      EXPECT_TRUE(is_missed || b[Quantity::kErrorEstimate] <= scene.accuracy.tolerance) << name;
      EXPECT_EQ(std::isnan(b[Quantity::kRhoI]), !plan.gives_rho) << name;
      if (!plan.gives_rho) continue;
      const double allowed = (a[Quantity::kRhoErrorEstimate] + b[Quantity::kRhoErrorEstimate]) *
                             std::max(a[Quantity::kRhoI], b[Quantity::kRhoI]);
      EXPECT_LE(std::abs(a[Quantity::kRhoI] - b[Quantity::kRhoI]), allowed) << name;
      EXPECT_LE(std::abs(a[Quantity::kRhoQ] - b[Quantity::kRhoQ]), allowed) << name;
    }
  }
  // Unless the plans drop each of these parts in several scenes, the test shows nothing.
  for (const Part part : kBounded) EXPECT_GE(dropped[part], 5) << static_cast<int>(part);
  EXPECT_GE(without_moments, 50);
  std::cout << without_moments << " scenes without moments\n";
}

TEST(Dropping, BistaticSourceWhereMomentsWeighNothing_KeepsTheBouncesOfItsBeam) {
  const SceneValues scene = parse_scene(
      R"(
[surface]
n = 3.7
k = 5.2
sigma = 0.5
q = 3
masking = "v-cavity"
scattering = "multiple"
[emission]
temperature_K = 245
[surroundings]
temperature_K = 245
[source]
irradiance = 1
[spectrum]
wavelength_um = 10
[geometry]
mode = "bistatic"
[grid]
theta_deg = [20, 60]
)",
      "s.toml");
  const SceneEntries entries = grid_entries(scene);
  const EffectPlan plan = plan_effects(scene, entries, false);
  EXPECT_FALSE(plan.kept.moments);
  EXPECT_TRUE(plan.kept.further_bounces);
  EXPECT_TRUE(plan.needs_beams);
}

// entry_extents groups points by wavelength. Each point is in one group, so a sum over the groups counts no point
// twice.
TEST(ExtentsOf, PointsAtTheirWavelengths_AreEachInOne) {
  const SceneEntries points({{10.0, {0.1, 2.0}, {}, 1}, {20.0, {0.3, 3.0}, {}, 0}, {30.0, {0.2, 4.0}, {}, 1}},
                            grid_variants(make_axes({}, {}, {}, {8.0, 9.0})));
  const std::vector<EntriesExtent> extents = entry_extents(SceneValues(), points);
  ASSERT_EQ(extents.size(), 2U);
  ASSERT_EQ(extents[0].beams.size(), 1U);
  EXPECT_EQ(extents[0].beams[0].theta_i_deg, 20.0);
  ASSERT_EQ(extents[1].beams.size(), 2U);
  EXPECT_EQ(extents[1].beams[0].theta_i_deg, 10.0);
  EXPECT_EQ(extents[1].beams[1].theta_i_deg, 30.0);
  EXPECT_EQ(extents[1].roughest, (SlopeShape{0.2, 2.0}));
  EXPECT_EQ(extents[1].smoothest, (SlopeShape{0.1, 4.0}));
}

TEST(EffectBounds, RandomScenes_HoldWhatEachPartChanges) {
  std::cout << "seed " << kSeed + 1 << '\n';
  RandomScenes scenes(kSeed + 1);
  std::map<Part, int> compared;
  for (std::size_t i = 0; i < draws_wanted(120); ++i) {
    SceneValues scene = scenes.next();
    scene.accuracy.tolerance = 1e-3;
    const std::vector<SceneEntry> entries = scenes.entries(scene);
    const EffectBounds bounds(scene, spectral_rule(scene), entry_extents(scene, entries).front());
    const std::vector<PointResult> whole = run(scene, entries, keep_everything(scene));
    for (const Part part : kBounded) {
      const double bound = bounds.bound(part, {});
      if (std::isinf(bound)) continue;
      const std::vector<PointResult> left = run(scene, entries, plan_to_keep(scene, without({}, part)));
      for (std::size_t j = 0; j < entries.size(); ++j) {
        const PointResult& a = whole[j];
        const PointResult& b = left[j];
        if (!(std::abs(a[Quantity::kStokesI]) > 0.0) || !(std::abs(b[Quantity::kStokesI]) > 0.0)) continue;
        const double change = polarisation_change(a, b);
        if (bound == 0.0) {
          EXPECT_LE(change, a[Quantity::kErrorEstimate] + b[Quantity::kErrorEstimate])
              << "part " << static_cast<int>(part) << " " << scene_text(scene, entries[j]);
          continue;
        }
        ++compared[part];
        EXPECT_LE(change, bound + a[Quantity::kErrorEstimate] + b[Quantity::kErrorEstimate] + kRounding)
            << "part " << static_cast<int>(part) << " " << scene_text(scene, entries[j]);
      }
    }
  }
  for (const Part part : kBounded) EXPECT_GE(compared[part], 30) << static_cast<int>(part);
}

}  // namespace
}  // namespace dolp::effects_test
