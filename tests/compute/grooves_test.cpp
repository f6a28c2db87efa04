// All bounces in V-grooves and the direct emission, on every kernel, against the reference and against what holds
// exactly.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <dolp/status.hpp>
#include "calibrate/random_entries.hpp"
#include "model/angles.hpp"
#include "mueller_support.hpp"
#include "properties_support.hpp"
#include "reference/reference_evaluator.hpp"
#include "rough_metal.hpp"
#include "run/scene_run.hpp"
#include "scene/scene_reader.hpp"

namespace dolp {
namespace {

MomentsRequest all_bounces(Distribution distribution, double tolerance) {
  MomentsRequest request;
  request.distribution = distribution;
  request.masking = Masking::kVCavity;
  request.scattering = Scattering::kMultiple;
  request.tolerance = tolerance;
  return request;
}

MomentsRequest direct_emission(Distribution distribution, Masking masking, double tolerance) {
  MomentsRequest request;
  request.distribution = distribution;
  request.masking = masking;
  request.wants_direct = true;
  request.tolerance = tolerance;
  return request;
}

class Grooves : public testing::TestWithParam<Kernel> {};

TEST_P(Grooves, Vacuum_ReflectsNothingAndEmitsAll) {
  const auto evaluator = make_evaluator(GetParam());
  for (const double theta_deg : {0.0, 45.0, 80.0}) {
    const double c = cos_sin_deg(theta_deg).cos;
    MomentsRequest bounces = all_bounces(Distribution::kCauchy, 1e-4);
    bounces.append({theta_deg, {0.3, 2.0}, {1.0, 0.0}});
    const Moments m = evaluator->evaluate(bounces, {}).front();
    EXPECT_NEAR(m.r_i, 0.0, m.r_i_error);
    EXPECT_NEAR(m.deficit, c, m.deficit_error + 1e-7);
    for (const Masking masking : {Masking::kVCavity, Masking::kSmith}) {
      MomentsRequest direct = direct_emission(Distribution::kCauchy, masking, 1e-4);
      direct.append({theta_deg, {0.3, 2.0}, {1.0, 0.0}});
      const Moments d = evaluator->evaluate(direct, {}).front();
      EXPECT_NEAR(d.direct_i, c, d.direct_i_error);
      EXPECT_NEAR(d.direct_q, 0.0, d.direct_q_error);
      EXPECT_LT(d.direct_i_error, 2e-4);
    }
  }
}

TEST_P(Grooves, WithoutAndWithTheDirectEmission_TheOtherMomentsAgree) {
  const auto evaluator = make_evaluator(GetParam());
  for (const Masking masking : {Masking::kVCavity, Masking::kSmith}) {
    MomentsRequest with = direct_emission(Distribution::kCauchy, masking, 1e-4);
    with.append({70.0, {0.4, 2.5}, {3.0, 4.0}});
    MomentsRequest without = with;
    without.wants_direct = false;
    const Moments a = evaluator->evaluate(with, {}).front();
    const Moments b = evaluator->evaluate(without, {}).front();
    EXPECT_NEAR(a.r_i, b.r_i, a.r_i_error + b.r_i_error);
    EXPECT_NEAR(a.deficit, b.deficit, a.deficit_error + b.deficit_error);
    EXPECT_TRUE(std::isnan(b.direct_i));
    // The emission of the facets alone is the lower bound; the loss of single scattering is the upper one.
    EXPECT_LE(a.direct_i, a.deficit);
  }
}

/// Largest distance from the reference over the bounds of both.
double worst_ratio(const MomentsRequest& request, double reference_tolerance) {
  CpuEvaluator kernel(Precision::kDouble);
  ReferenceEvaluator reference({.relative_tolerance = reference_tolerance});
  const std::vector<Moments> own = kernel.evaluate(request, {});
  const std::vector<Moments> other = reference.evaluate(request, {});
  double worst = 0.0;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const Point point{request[i].theta_deg, request[i].shape, request[i].index};
    worst = std::max(worst, expect_within_bounds(own[i], other[i], text_of(point)));
  }
  return worst;
}

void append_random(MomentsRequest& request, Domain domain, std::uint64_t seed, int count) {
  Draw draw(seed);
  for (int i = 0; i < count; ++i) request.append(random_entry(draw, domain, request.distribution, request.masking));
}

TEST(GroovesReference, DirectEmission_WithinTheBounds) {
  for (const Distribution distribution : {Distribution::kCauchy, Distribution::kGaussian}) {
    for (const Masking masking : {Masking::kVCavity, Masking::kSmith}) {
      MomentsRequest request = direct_emission(distribution, masking, 1e-4);
      append_random(request, Domain::kOrdinary, 12, 20);
      append_random(request, Domain::kCorners, 13, 20);
      std::printf("%s %s: worst %.2g\n", name_of(distribution), name_of(masking), worst_ratio(request, 1e-6));
    }
  }
}

// ---- pBRDF ---------------------------------------------------------------------------------------------------------

ScatteringRequest bounces_of(const std::vector<ScatteringPoint>& points) {
  ScatteringRequest request = request_of(Distribution::kCauchy, Masking::kVCavity, points);
  request.scattering = Scattering::kMultiple;
  return request;
}

const std::vector<ScatteringPoint> kBeams = {
    {{40.0, 20.0, 180.0}, {0.3, 2.0}, {1.5, 0.1}},  {{40.0, 20.0, 75.0}, {0.5, 2.5}, {10.0, 60.0}},
    {{10.0, 70.0, -130.0}, {0.4, 3.0}, {3.0, 4.0}}, {{65.0, 64.0, 20.0}, {0.6, 2.0}, {26.0, 90.0}},
    {{0.0, 50.0, 30.0}, {0.5, 2.0}, {10.0, 60.0}},  {{80.0, 75.0, 170.0}, {0.2, 1.5}, {1.33, 0.02}},
    {{50.0, 50.0, 0.0}, {0.5, 3.0}, {3.0, 4.0}}};

TEST_P(Grooves, MuellerMatrices_AreThoseOfTheReference) {
  const auto evaluator = make_evaluator(GetParam());
  const std::vector<ScatteringMatrix> own = evaluator->scattering()->scatter(bounces_of(kBeams), {});
  const std::vector<ScatteringMatrix> other = ReferenceEvaluator().scatter(bounces_of(kBeams), {});
  for (std::size_t i = 0; i < own.size(); ++i) {
    EXPECT_LT(own[i].error, 3e-5 * own[i].m[0]) << text_of(kBeams[i]);
    for (std::size_t j = 0; j < own[i].m.size(); ++j) {
      EXPECT_NEAR(own[i].m[j], other[i].m[j], own[i].error + other[i].error) << text_of(kBeams[i]) << " element " << j;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EveryKernel, Grooves, testing::ValuesIn(kKernels),
                         [](const auto& test) { return name_of(test.param); });

TEST(GroovesMueller, FurtherBounces_AreReciprocal) {
  CpuEvaluator evaluator(Precision::kDouble);
  std::vector<ScatteringPoint> reversed = kBeams;
  for (ScatteringPoint& point : reversed) std::swap(point.angles.theta_i_deg, point.angles.theta_r_deg);
  const std::vector<ScatteringMatrix> there = evaluator.scatter(bounces_of(kBeams), {});
  const std::vector<ScatteringMatrix> back = evaluator.scatter(bounces_of(reversed), {});
  constexpr std::array<double, 4> kSigns = {1.0, 1.0, 1.0, -1.0};  // at the same azimuth
  for (std::size_t i = 0; i < there.size(); ++i) {
    for (std::size_t row = 0; row < 4; ++row) {
      for (std::size_t column = 0; column < 4; ++column) {
        EXPECT_NEAR(there[i].m[4 * row + column], kSigns[row] * kSigns[column] * back[i].m[4 * column + row],
                    there[i].error + back[i].error)
            << text_of(kBeams[i]);
      }
    }
  }
}

TEST(GroovesMueller, TowardTheMirrorDirection_IsNotDefined) {
  CpuEvaluator evaluator(Precision::kDouble);
  const auto matrix = evaluator.scatter(bounces_of({{{40.0, 40.0, 180.0}, {0.3, 2.0}, {1.5, 0.1}}}), {}).front();
  for (const double element : matrix.m) EXPECT_TRUE(std::isnan(element));
}

// ---- Scenes --------------------------------------------------------------------------------------------------------

std::vector<PointResult> results_of(const std::vector<std::string>& overrides) {
  const SceneValues scene = parse_scene(kRoughMetal, "s.toml", settings_from_text(overrides));
  CpuEvaluator evaluator(Precision::kDouble);
  return evaluate_scene(scene, grid_entries(scene), evaluator, {});
}

TEST(GroovesScene, UpToTheHorizon_NothingIsUnphysical) {
  const std::vector<PointResult> results =
      results_of({"surface.scattering=multiple", "grid.theta_deg=[0, 30, 60, 80, 89, 89.99, 90]"});
  for (const PointResult& r : results) {
    EXPECT_EQ(r.status & (kReflectanceOutsideZeroToOne | kIntensityNotPositive | kOutsideModelDomain), 0U);
    EXPECT_EQ(r[Quantity::kAlbedo], 1.0);
    EXPECT_TRUE(r[Quantity::kEmissivityS] > 0.0 && r[Quantity::kEmissivityS] <= r[Quantity::kEmissivityP] + 1e-9 &&
                r[Quantity::kEmissivityP] < 1.0);
    EXPECT_NEAR(0.5 * (r[Quantity::kEmissivityS] + r[Quantity::kEmissivityP]) + r[Quantity::kRhoI], 1.0, 1e-12);
  }
  // The emissivity of the metal is a seventh of what single scattering says, the DOLP ten times as large.
  EXPECT_NEAR(0.5 * (results[2][Quantity::kEmissivityS] + results[2][Quantity::kEmissivityP]), 0.01635, 1e-5);
  EXPECT_NEAR(results[2][Quantity::kDolp], 0.3892, 1e-4);
}

TEST(GroovesScene, AllBounces_LieInTheBracket) {
  const std::vector<std::string> grid = {"grid.theta_deg=[0, 30, 60, 80]"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), grid.begin(), grid.end());
    return results_of(more);
  };
  const std::vector<PointResult> all = with({"surface.scattering=multiple"});
  for (const char* model : {"emission.model=moments", "emission.model=direct"}) {
    const std::vector<PointResult> between = with({"emission.bracket=true", model});
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_LE(between[i][Quantity::kDolpLow], all[i][Quantity::kDolp] + 1e-4);
      EXPECT_GE(between[i][Quantity::kDolpHigh], all[i][Quantity::kDolp] - 1e-4);
      EXPECT_LE(between[i][Quantity::kDolpLow], between[i][Quantity::kDolp] + 1e-4);
      EXPECT_GE(between[i][Quantity::kDolpHigh], between[i][Quantity::kDolp] - 1e-4);
    }
  }
}

// The bracket follows from the emissivities of both ends (section 4 of the model).
TEST(GroovesScene, Bracket_IsWhatItsEndsSay) {
  const std::vector<std::string> surroundings = {"grid.theta_deg=[60]", "surroundings.temperature_K=250"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), surroundings.begin(), surroundings.end());
    return results_of(more).front();
  };
  const PointResult single = with({"emission.bracket=true"});
  const PointResult direct = with({"emission.model=direct"});
  const double single_i = 0.5 * (single[Quantity::kEmissivityS] + single[Quantity::kEmissivityP]);
  const double direct_i = 0.5 * (direct[Quantity::kEmissivityS] + direct[Quantity::kEmissivityP]);
  const double direct_q = 0.5 * (direct[Quantity::kEmissivityS] - direct[Quantity::kEmissivityP]);
  const double slack = single_i - direct_i;
  // Q = N eps_Q with the same N for all: that of single scattering gives it.
  const double net = single[Quantity::kStokesQ] / (-single[Quantity::kRhoQ]);
  EXPECT_NEAR(single[Quantity::kDolpHigh], std::abs(net) * (std::abs(direct_q) + slack) / single[Quantity::kStokesI],
              1e-4);
  EXPECT_NEAR(single[Quantity::kDolpLow],
              std::abs(net) * std::max(std::abs(direct_q) - slack, 0.0) / single[Quantity::kStokesI], 1e-4);
}

TEST(GroovesScene, SmoothSurface_PlanLeavesTheBouncesOut) {
  const std::vector<std::string> smooth = {"surface.scattering=multiple", "surface.sigma=0.02",
                                           "grid.theta_deg=[0, 45]"};
  const SceneValues scene = parse_scene(kRoughMetal, "s.toml", settings_from_text(smooth));
  const EffectPlan plan = plan_effects(scene, grid_entries(scene), false);
  EXPECT_FALSE(plan.kept.further_bounces);
  EXPECT_TRUE(plan.kept.moments);
  const SceneValues rough = parse_scene(kRoughMetal, "s.toml", {{"surface.scattering", "multiple"}});
  EXPECT_TRUE(plan_effects(rough, grid_entries(rough), false).kept.further_bounces);
}

}  // namespace
}  // namespace dolp
