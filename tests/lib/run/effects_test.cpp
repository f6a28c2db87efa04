// Effects that a plan drops. Results with and without these effects must agree within the stated errors.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <map>

#include <dolp/status.hpp>
#include "draws.hpp"
#include "fixed_precision.hpp"
#include "model/choices.hpp"
#include "plan/effects.hpp"
#include "properties_support.hpp"
#include "run/scene_run.hpp"
#include "scene/scene_reader.hpp"

namespace dolp::effects_test {
namespace {

constexpr std::uint64_t kSeed = 20250901;
/// Parts of a scene for which the plan gives a bound of their effect on DOLP. The bound is finite and above 0.
constexpr std::array kBounded = {Part::kSource, Part::kSurroundings, Part::kEmission, Part::kPathRadiance};
// Rounding error of a quotient of two sums of Stokes parameters.
constexpr double kRounding = 1e-11;

/// Random scenes with any choice of effects, such as emission, source and path. Many scenes have a negligible effect.
class RandomScenes {
 public:
  explicit RandomScenes(std::uint64_t seed) : random_(seed) {}

  SceneValues next() {
    SceneValues scene;
    const Model& model = kModels[static_cast<std::size_t>(random_.uniform(0.0, 8.0))];
    scene.surface.distribution = model.distribution;
    scene.surface.masking = model.masking;
    scene.surface.material.constant = {random_.log_uniform(0.3, 30.0), coin() ? 0.0 : random_.log_uniform(1e-4, 90.0)};
    if (random_.chance(0.1)) scene.surface.material.constant = {1.0 + random_.log_uniform(1e-6, 1e-2), 0.0};
    scene.surface.specular = random_.chance(0.2) ? random_.log_uniform(1e-9, 1.0) : random_.uniform(0.3, 1.0);
    if (random_.chance(0.05)) scene.surface.specular = 0.0;
    scene.surface.diffuse = coin() ? 0.0 : random_.log_uniform(1e-9, 0.5);
    scene.surface.diffuse_exponent = coin() ? 0.0 : random_.uniform(-0.9, 0.0);
    scene.spectrum.min_um = scene.spectrum.max_um = random_.log_uniform(0.5, 100.0);
    if (coin()) scene.spectrum.max_um *= random_.uniform(1.01, 1.6);
    scene.geometry.mode = coin() ? Mode::kHemispherical : Mode::kBistatic;
    scene.geometry.view_zenith_deg = random_.chance(0.1) ? 90.0 : random_.uniform(0.0, 89.0);
    scene.geometry.relative_azimuth_deg = coin() ? 180.0 : random_.uniform(0.0, 360.0);
    scene.accuracy.tolerance = std::pow(10.0, -random_.uniform(2.0, 6.0));
    scene.accuracy.precision = Precision::kDouble;
    add_radiation(scene);
    if (scene.emission && keeps_projected_area(model.masking) && random_.chance(0.3))
      scene.emission->model = EmissionModel::kDirect;
    if (random_.chance(0.1)) scene.surface.material = resonance(scene.spectrum);
    const bool is_direct = scene.emission && scene.emission->model == EmissionModel::kDirect;
    if (model.masking == Masking::kVCavity && !is_direct && coin()) scene.surface.scattering = Scattering::kMultiple;
    return scene;
  }

  std::vector<SceneEntry> entries(const SceneValues& scene) {
    const Model model{scene.surface.distribution, scene.surface.masking};
    std::vector<SceneEntry> drawn;
    const bool has_grazing = random_.chance(0.3);
    SlopeShape shape = random_.shape(model);
    if (coin()) shape = {random_.log_uniform(0.02, 1.0), random_.uniform(1.6, 6.0)};
    if (random_.chance(0.05)) shape.sigma = 0.0;
    if (scene.surface.scattering == Scattering::kMultiple && coin()) shape.sigma *= random_.log_uniform(1e-3, 1e-1);
    const double spread = coin() ? 1.0 : random_.uniform(1.0, 2.0);
    for (int i = 0; i < 5; ++i) {
      drawn.push_back({has_grazing ? random_.theta_deg() : random_.uniform(0.0, 85.0), shape, {}});
      shape = {shape.sigma * spread, shape.q * std::sqrt(spread)};
    }
    return drawn;
  }

 private:
  bool coin() { return random_.chance(0.5); }
  double temperature_K() {  // the radiance at 1 K is 0 in double
    return random_.chance(0.05) ? 1.0 : random_.log_uniform(100.0, 6000.0);
  }

  void add_radiation(SceneValues& scene) {
    if (random_.chance(0.8)) scene.emission = Emission{temperature_K(), EmissionModel::kMoments};
    if (scene.emission && random_.chance(0.3)) scene.emission->model = EmissionModel::kFresnel;
    if (random_.chance(0.6)) scene.surroundings = Surroundings{temperature_K()};
    if (scene.emission && scene.surroundings && coin()) {
      const double gap = random_.chance(0.3) ? 0.0 : random_.log_uniform(1e-6, 1.0);
      scene.surroundings->temperature_K = scene.emission->temperature_K * (coin() ? 1.0 + gap : 1.0 / (1.0 + gap));
    }
    if (coin() || (!scene.emission && !scene.surroundings)) {
      scene.source = Source{};
      scene.source->irradiance = random_.log_uniform(1e-9, 1e6);
      if (scene.emission && coin()) {
        scene.source->relative_irradiance = random_.log_uniform(1e-7, 1e3);
      }
    }
    if (random_.chance(0.3)) {
      scene.path = Path{coin() ? 1.0 : random_.uniform(0.0, 1.0), std::nullopt, std::nullopt};
      if (coin()) scene.path->radiance = random_.log_uniform(1e-9, 1e3);
    }
  }

  Material resonance(const Spectrum& spectrum) {
    Material material;
    material.name = "resonance";
    const double low = 0.9 * spectrum.min_um;
    const double high = 1.1 * spectrum.max_um;
    material.n.wavelength_um = material.k.wavelength_um = {low, 0.5 * (low + high), high};
    material.n.value = {random_.uniform(0.5, 2.0), random_.uniform(1.0, 3.0), random_.uniform(1.0, 2.0)};
    material.k.value = {random_.uniform(0.0, 1.0), random_.uniform(0.0, 2.0), random_.uniform(0.0, 0.5)};
    return material;
  }

  Random random_;
};

std::string scene_text(const SceneValues& s) {
  std::string text = fmt::format(
      "{} N {:.6g}+{:.6g}i k_s {:.4g} k_d {:.4g} c {:.3g}, {:.4g}..{:.4g} um, {} view {:.5g} azimuth {:.5g}, tolerance "
      "{:.2g}",
      to_name(Model{s.surface.distribution, s.surface.masking}), s.surface.material.constant.n,
      s.surface.material.constant.k, s.surface.specular, s.surface.diffuse, s.surface.diffuse_exponent,
      s.spectrum.min_um, s.spectrum.max_um, to_name(s.geometry.mode), s.geometry.view_zenith_deg,
      s.geometry.relative_azimuth_deg, s.accuracy.tolerance);
  if (s.emission) text += fmt::format(", emission {:.9g} K {}", s.emission->temperature_K, to_name(s.emission->model));
  if (s.surroundings) text += fmt::format(", surroundings {:.9g} K", s.surroundings->temperature_K);
  if (s.source)
    text += fmt::format(", source {:.4g} or {:.4g}", s.source->irradiance, s.source->relative_irradiance.value_or(0.0));
  if (s.path)
    text += fmt::format(", path {:.3g} radiance {:.4g}", s.path->transmittance, s.path->radiance.value_or(0.0));
  return text;
}

std::string scene_text(const SceneValues& scene, const SceneEntry& entry) {
  return fmt::format("{}; theta {:.9g} sigma {:.6g} q {:.6g}", scene_text(scene), entry.theta_deg, entry.shape.sigma,
                     entry.shape.q);
}

std::vector<PointResult> run(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan) {
  FixedPrecision evaluator(Precision::kDouble);
  return evaluate_scene(scene, entries, evaluator, {}, plan);
}

/// Distance of two results in the plane of Q/I and U/I.
double polarisation_change(const PointResult& a, const PointResult& b) {
  return std::hypot(a[Quantity::kStokesQ] / a[Quantity::kStokesI] - b[Quantity::kStokesQ] / b[Quantity::kStokesI],
                    a[Quantity::kStokesU] / a[Quantity::kStokesI] - b[Quantity::kStokesU] / b[Quantity::kStokesI]);
}

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
