// Which effects a plan drops, and that the answer without them is the one with them, within the stated bounds.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <map>

#include "effects_support.hpp"
#include "model/angles.hpp"
#include "model/scattering.hpp"
#include "model/status.hpp"

namespace dolp {
namespace {

using namespace effects_support;

constexpr std::uint64_t kSeed = 20250901;
constexpr std::array kParts = {Part::kMoments,  Part::kSource,       Part::kSurroundings,
                               Part::kEmission, Part::kPathRadiance, Part::kDiffuse};
// Rounding of a quotient of Stokes sums.
constexpr double kRounding = 1e-11;
// What the kernel's own exponential may take for 0.
constexpr double kUnderflow = 1e-300;

int scene_count(int standard) {
  const char* wanted = std::getenv("DOLP_PROPERTY_DRAWS");
  return wanted ? std::atoi(wanted) : standard;
}

TEST(Dropping, RandomScenes_TheAnswerWithEverythingIsWithinTheEstimates) {
  std::cout << "seed " << kSeed << '\n';
  RandomScenes scenes(kSeed);
  std::map<Part, int> dropped;
  int without_moments = 0;
  for (int i = 0; i < scene_count(400); ++i) {
    const Scene scene = scenes.next();
    const std::vector<SceneEntry> entries = scenes.entries(scene);
    const EffectPlan plan = plan_effects(scene, entries, false);
    EXPECT_LE(plan.bound.dolp, kDroppedShare * scene.accuracy.tolerance);
    EXPECT_LE(plan.bound.rho, kDroppedShare * scene.accuracy.tolerance);
    if (plan.dropped.empty() && plan.needs_moments) continue;
    for (const DroppedPart& part : plan.dropped) ++dropped[part.part];
    without_moments += plan.needs_moments ? 0 : 1;
    const std::vector<PointResult> whole = run(scene, entries, keep_everything(scene));
    const std::vector<PointResult> left = run(scene, entries, plan);
    for (std::size_t j = 0; j < entries.size(); ++j) {
      const PointResult& a = whole[j];
      const PointResult& b = left[j];
      const std::string name =
          describe(scene, entries[j]) + "; " + effects_text(effect_rows(scene, entries, plan), plan);
      if ((a.status & kStatusOutsideDomain) != 0) {
        EXPECT_EQ(std::isnan(a.stokes_i), std::isnan(b.stokes_i)) << name;
        continue;
      }
      if (!promises_dolp(a.status)) continue;
      EXPECT_EQ(b.status & kStatusNoDolpPromised, 0U) << name;
      EXPECT_LE(std::abs(a.dolp - b.dolp), a.error_estimate + b.error_estimate) << name;
      EXPECT_GE(b.error_estimate, plan.bound.dolp) << name;
      const bool is_missed = (b.status & kStatusToleranceMissed) != 0;
      EXPECT_TRUE(is_missed || b.error_estimate <= scene.accuracy.tolerance) << name;
      EXPECT_EQ(std::isnan(b.rho_i), !plan.gives_rho) << name;
      if (!plan.gives_rho) continue;
      const double allowed = (a.rho_error_estimate + b.rho_error_estimate) * std::max(a.rho_i, b.rho_i);
      EXPECT_LE(std::abs(a.rho_i - b.rho_i), allowed) << name;
      EXPECT_LE(std::abs(a.rho_q - b.rho_q), allowed) << name;
    }
  }
  // The test is about something only if all of this happens.
  for (const Part part : kParts) EXPECT_GE(dropped[part], 5) << static_cast<int>(part);
  EXPECT_GE(without_moments, 50);
  std::cout << without_moments << " scenes without moments\n";
}

TEST(Influence, RandomScenes_BoundsWhatEachPartChanges) {
  std::cout << "seed " << kSeed + 1 << '\n';
  RandomScenes scenes(kSeed + 1);
  std::map<Part, int> compared;
  for (int i = 0; i < scene_count(100); ++i) {
    Scene scene = scenes.next();
    scene.accuracy.tolerance = 1e-3;
    const std::vector<SceneEntry> entries = scenes.entries(scene);
    const SpectralRule rule = spectral_rule(scene);
    const InfluenceBounds bounds(scene, rule);
    const std::vector<PointResult> whole = run(scene, entries, keep_everything(scene));
    for (const Part part : kParts) {
      const std::vector<PointResult> left = run(scene, entries, plan_without(scene, part));
      for (std::size_t j = 0; j < entries.size(); ++j) {
        const PointResult& a = whole[j];
        const PointResult& b = left[j];
        const DropBound bound = bounds.bound(part, {}, entries[j]);
        if (!(std::abs(a.stokes_i) > 0.0) || !(std::abs(b.stokes_i) > 0.0)) continue;
        const double change = polarisation_change(a, b);
        if (bound.dolp == 0.0) {
          EXPECT_LE(change, a.error_estimate + b.error_estimate) << describe(scene, entries[j]);
          continue;
        }
        ++compared[part];
        EXPECT_LE(change, bound.dolp + a.error_estimate + b.error_estimate + kRounding)
            << "part " << static_cast<int>(part) << " " << describe(scene, entries[j]);
      }
    }
  }
  for (const Part part : kParts) EXPECT_GE(compared[part], 30) << static_cast<int>(part);
}

TEST(FacetBounds, RandomSurfaces_HoldTheMoments) {
  std::cout << "seed " << kSeed + 2 << '\n';
  Random random(kSeed + 2);
  for (const Model& model : kModels) {
    const std::vector<Point> points = random.points(model, 400);
    CpuEvaluator evaluator(Precision::kDouble);
    const std::vector<Moments> moments = evaluator.evaluate(request_of(model, points, 1e-5), {});
    Surface surface;
    surface.distribution = model.distribution;
    surface.masking = model.masking;
    double tightest = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Point& p = points[i];
      const double c = cos_sin_deg(p.theta_deg).cos;
      if (c == 0.0) continue;
      const Moments& m = moments[i];
      const std::string where = std::string(name_of(model)) + " " + text_of(p);
      for (const Detail detail : {Detail::kMiddle, Detail::kFine}) {
        const ReflectanceBounds bounds = reflectance_bounds(surface, p.theta_deg, p.shape, {&p.index, 1}, detail);
        EXPECT_GE(bounds.most_q * c, std::abs(m.r_q) - m.r_q_error) << where;
        EXPECT_GE(bounds.most_i * c, m.r_i + std::abs(m.r_q) - 2.0 * m.r_i_error) << where;
        EXPECT_LE(bounds.least_i * c, m.r_i + m.r_i_error) << where;
        tightest = std::max(tightest, m.r_i / (bounds.most_i * c));
      }
      const ReflectanceBounds coarse = coarse_reflectance_bounds(surface, p.theta_deg, p.shape);
      EXPECT_GE(coarse.most_i * c, m.r_i + std::abs(m.r_q) - 2.0 * m.r_i_error) << where;
    }
    EXPECT_GE(tightest, 0.5) << "bounds that say nothing";
  }
}

TEST(FacetBounds, WhereTheBeamIsNotDefined_ThereIsNone) {
  const OpticalConstants index{1.5, 0.1};
  const auto most_i = [&](const BeamAngles& a, double sigma) {
    return beam_bounds(Surface{}, a.theta_i_deg, a.theta_r_deg, a.delta_phi_deg, {.sigma = sigma}, {&index, 1}).most_i;
  };
  for (const BeamAngles& specular : {BeamAngles{30, 30, 180}, BeamAngles{30, 30, -180}, BeamAngles{0, 0, 90}}) {
    EXPECT_TRUE(std::isinf(most_i(specular, 0.0))) << specular.theta_i_deg;
    EXPECT_TRUE(std::isfinite(most_i(specular, 0.1))) << specular.theta_i_deg;
  }
  EXPECT_EQ(most_i({30, 31, 180}, 0.0), 0.0);
  EXPECT_TRUE(std::isinf(most_i({90, 90, 10}, 0.1)));
}

TEST(FacetBounds, RandomGeometries_HoldTheBeam) {
  std::cout << "seed " << kSeed + 3 << '\n';
  Random random(kSeed + 3);
  CpuEvaluator evaluator(Precision::kDouble);
  for (const Model& model : kModels) {
    Surface surface;
    surface.distribution = model.distribution;
    surface.masking = model.masking;
    for (int i = 0; i < 60; ++i) {
      const Beams b = random.beams();
      const Point p = random.point(model);
      const ScatteringRequest request{.distribution = model.distribution,
                                      .masking = model.masking,
                                      .precision = Precision::kDouble,
                                      .angles = {{b.theta_i_deg, b.theta_r_deg, b.delta_phi_deg}},
                                      .shapes = {p.shape},
                                      .indices = {p.index},
                                      .entries = {{}}};
      const ScatteringMatrix f = evaluator.scatter(request, {}).front();
      const BeamBounds bounds =
          beam_bounds(surface, b.theta_i_deg, b.theta_r_deg, b.delta_phi_deg, p.shape, {&p.index, 1});
      const std::string name = name_of(model) + " " + text_of(p) + " " + text_of(b);
      EXPECT_GE(bounds.most_i * (1.0 + kRounding), f.m[0] - f.error) << name;
      EXPECT_LE(bounds.least_i * (1.0 - kRounding), f.m[0] + f.error + kUnderflow) << name;
      EXPECT_GE(bounds.most_qu * (1.0 + kRounding), std::hypot(f.m[4], f.m[8]) - 2.0 * f.error) << name;
    }
  }
}

}  // namespace
}  // namespace dolp
