// A thinned rule against the rule from which it comes: sums at other angles than those that choose the samples.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "draws.hpp"
#include "model/smooth_surface.hpp"
#include "scene/material_data.hpp"
#include "scene/sky_profile.hpp"
#include "spectrum/spectral_rule.hpp"

namespace thinned_rule_test {

using namespace dolp;

constexpr std::uint64_t kSeed = 20261129;
constexpr int kScenes = 12;
constexpr double kSmallestPart = 1e-4;  // as in nodes_error(): below this share, an error is relative to all radiation

SceneModel coated_scene(const std::string& medium, const std::string& film, double thickness_um) {
  SceneModel scene;
  scene.surface.material = named_material(medium, "");
  scene.surface.coating = {{named_material(film, ""), thickness_um}};
  scene.emission.emplace().temperature_K = 300.0;
  scene.surroundings.emplace().set_sky(*built_in_sky("clear-sky"));
  scene.spectrum = {7.5, 13.5};
  scene.accuracy.tolerance = 1e-4;
  return scene;
}

/// The error of the sum of `factor` times 1 - R at an angle, for the polarisation with the larger error, relative to
/// the absorbed or the reflected radiation, whichever is smaller.
template <class Factor>
double sum_error(const SpectralRule& all, const SpectralRule& few, double cosine, const Factor& factor) {
  double whole = 0.0, s = 0.0, p = 0.0, off_s = 0.0, off_p = 0.0;
  for (const SpectralSample& sample : all.samples) {
    const SmoothAbsorptance at = smooth_absorptance(sample.index, cosine);
    whole += factor(sample);
    s += factor(sample) * at.s;
    p += factor(sample) * at.p;
  }
  for (const SpectralSample& sample : few.samples) {
    const SmoothAbsorptance at = smooth_absorptance(sample.index, cosine);
    off_s += factor(sample) * at.s;
    off_p += factor(sample) * at.p;
  }
  const double absorbed = 0.5 * (s + p);
  const double part = std::max(std::min(absorbed, whole - absorbed), kSmallestPart * whole);
  return std::max(std::abs(off_s - s), std::abs(off_p - p)) / part;
}

TEST(ThinnedRule, RandomFilms_SumsKeepTheirBound_WithFewerSamples) {
  Draws random(kSeed);
  std::size_t samples_of_all = 0, samples_of_few = 0;
  for (int i = 0; i < kScenes; ++i) {
    const std::vector<std::string> media = {"iron", "aluminium (Rakic)", "water 25C"};
    const std::vector<std::string> films = {"PMMA acrylic", "PET", "SiO2 fused silica"};
    SceneModel scene =
        coated_scene(media[random.count(0, 2)], films[random.count(0, 2)], random.log_uniform(0.3, 60.0));
    scene.accuracy.tolerance = random.log_uniform(1e-6, 1e-3);
    const SpectralRule all = spectral_rule(scene);
    const SpectralRule few = thinned_rule(scene, all);
    SCOPED_TRACE(scene.surface.coating.front().material.name + " on " + scene.surface.material.name);
    samples_of_all += all.samples.size();
    samples_of_few += few.samples.size();
    EXPECT_LE(few.relative_error, all.relative_error + 0.07 * scene.accuracy.tolerance);
    const double bound = few.relative_error - all.relative_error;
    for (int angle = 0; angle < 40; ++angle) {
      const double cosine = random.uniform(0.0, 1.0);
      EXPECT_LE(sum_error(all, few, cosine, [](const auto& at) { return at.emitted; }), bound) << cosine;
      EXPECT_LE(sum_error(all, few, cosine, [](const auto& at) { return at.surroundings; }), bound) << cosine;
      EXPECT_LE(sum_error(all, few, cosine, [](const auto& at) { return at.width; }), bound) << cosine;
      // The sky at a node is a share of its mean plus a difference; only their sum is no difference of large numbers.
      EXPECT_LE(sum_error(all, few, cosine, [](const auto& at) { return at.surroundings + at.sky[3]; }), bound);
    }
  }
  EXPECT_LT(samples_of_few, samples_of_all / 3);
}

TEST(ThinnedRule, WhatIsNotLinearInTheCurves_KeepsAllSamples) {
  SceneModel scene = coated_scene("iron", "PMMA acrylic", 20.0);
  const SpectralRule all = spectral_rule(scene);
  EXPECT_LT(thinned_rule(scene, all).samples.size(), all.samples.size());
  scene.surface.diffuse = 0.2;
  scene.surface.diffuse_polarisation = DiffusePolarisation::kTransmission;
  EXPECT_EQ(thinned_rule(scene, all).samples.size(), all.samples.size());
  scene.surface.diffuse = 0.0;
  EXPECT_LT(thinned_rule(scene, all).samples.size(), all.samples.size());
}

TEST(SpectralRules, EntriesWithTheirOwnIndex_KeepAllSamples) {
  const SceneModel scene = coated_scene("iron", "PMMA acrylic", 20.0);
  const std::size_t all = spectral_rule(scene).samples.size();
  const SceneEntry plain{60.0, {0.2, 3.0}, {}};
  const SceneEntry own{60.0, {0.2, 3.0}, OpticalConstants{5.0, 8.0}};
  EXPECT_LT(SpectralRules(scene, {plain}).at({})->samples.size(), all / 3);
  EXPECT_EQ(SpectralRules(scene, {plain, own}).at({})->samples.size(), all);
}

}  // namespace thinned_rule_test
