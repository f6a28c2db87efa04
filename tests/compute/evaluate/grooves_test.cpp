// Two models of the light, with every kernel: all bounces in V-grooves, and direct emission, which goes straight from a
// facet to the viewer. Results must agree with stored values and with the reference evaluator, and must have properties
// that hold for all inputs.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <dolp/status.hpp>
#include "beams/scattering.hpp"
#include "calibrate/random_entries.hpp"
#include "evaluate/remembering_evaluator.hpp"
#include "model/angles.hpp"
#include "mueller_support.hpp"
#include "properties_support.hpp"
#include "reference/reference_evaluator.hpp"
#include "rough_metal.hpp"
#include "run/scene_run.hpp"
#include "scene/scene_reader.hpp"
#include "verify/qualification.hpp"

namespace dolp::grooves_test {
namespace {

constexpr std::array kDistributions = {Distribution::kCauchy, Distribution::kGaussian};
constexpr std::array kDirectMaskings = {Masking::kVCavity, Masking::kSmith};

std::vector<StoredCase> stored_cases() { return read_stored_cases(DOLP_TEST_DATA_DIR "/groove_cases.csv"); }

MomentsRequest all_bounces(Distribution distribution, const std::vector<Point>& points, double tolerance) {
  MomentsRequest request = request_of({distribution, Masking::kVCavity}, points, tolerance);
  request.scattering = Scattering::kMultiple;
  return request;
}

MomentsRequest direct_emission(Distribution distribution, Masking masking, const std::vector<Point>& points) {
  MomentsRequest request = request_of({distribution, masking}, points, 1e-4);
  request.wants_direct = true;
  return request;
}

std::vector<double> tolerances_of(Kernel kernel) {
  return is_double(kernel) ? std::vector{1e-2, 1e-4, 1e-6} : std::vector{1e-2, 1e-4};
}

constexpr std::uint64_t kSeed = 20261122;
constexpr std::size_t kPoints = 30;
constexpr double kNextToTheHorizon = 89.999;  // degrees

std::vector<Point> random_points(Distribution distribution) {
  const std::uint64_t seed = kSeed + static_cast<std::uint64_t>(distribution);
  std::vector<Point> points = Random(seed).points({distribution, Masking::kVCavity}, kPoints);
  for (Point& point : points) {
    if (point.theta_deg < 90.0) point.theta_deg = std::min(point.theta_deg, kNextToTheHorizon);
  }
  return points;
}

class Grooves : public testing::TestWithParam<Kernel> {
 protected:
  std::unique_ptr<ModelEvaluator> evaluator_ = make_evaluator(GetParam());
};

// ---- Moments -------------------------------------------------------------------------------------------------------

TEST_P(Grooves, StoredCases_AreWithinTheBounds) {
  for (const Distribution distribution : kDistributions) {
    std::vector<StoredCase> cases = stored_cases();
    std::erase_if(cases, [&](const StoredCase& c) { return c.distribution != distribution; });
    std::vector<Point> points;
    for (const StoredCase& c : cases) points.push_back({c.theta_deg, c.shape, c.index});
    for (const double tolerance : tolerances_of(GetParam())) {
      const std::vector<Moments> moments = evaluator_->evaluate(all_bounces(distribution, points, tolerance), {});
      double worst = 0.0;
      for (std::size_t i = 0; i < cases.size(); ++i) {
        worst = std::max(worst, expect_within_bounds(cases[i].moments, moments[i], cases[i].name));
      }
      std::printf("%s %.0e: %zu cases, worst %.2g of its bound\n", to_name(distribution), tolerance, cases.size(),
                  worst);
    }
  }
}

TEST_P(Grooves, AlbedoIsOne_AndNothingIsLost) {
  const double rounding = is_double(GetParam()) ? 1e-12 : 2e-6;
  for (const Distribution distribution : kDistributions) {
    const std::vector<Point> points = random_points(distribution);
    for (const double tolerance : tolerances_of(GetParam())) {
      const auto moments = evaluator_->evaluate(all_bounces(distribution, points, tolerance), {});
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Moments& m = moments[i];
        const double c = cos_sin_deg(points[i].theta_deg).cos;
        const std::string where = text_of(points[i]);
        EXPECT_NEAR(m.albedo, c, rounding * c) << where;
        EXPECT_NEAR(m.r_i + m.deficit, c, std::min(rounding * c, m.r_i_error + m.deficit_error)) << where;
        EXPECT_TRUE(m.r_i >= 0.0 && m.r_i <= (1.0 + rounding) * c && m.deficit >= 0.0) << where;
        EXPECT_LE(std::abs(m.r_q), (1.0 + rounding) * m.r_i) << where;
        for (const auto& [value, error] : kHemisphereMembers) EXPECT_GE(m.*error, 0.0) << where;
      }
    }
  }
}

TEST_P(Grooves, Vacuum_ReflectsNothingAndEmitsAll) {
  for (const double theta_deg : {0.0, 45.0, 80.0}) {
    const double c = cos_sin_deg(theta_deg).cos;
    const std::vector<Point> vacuum = {{theta_deg, {0.3, 2.0}, {1.0, 0.0}}};
    const Moments m = evaluator_->evaluate(all_bounces(Distribution::kCauchy, vacuum, 1e-4), {}).front();
    EXPECT_NEAR(m.r_i, 0.0, m.r_i_error);
    EXPECT_NEAR(m.deficit, c, m.deficit_error + 1e-7);
    for (const Masking masking : kDirectMaskings) {
      const Moments d = evaluator_->evaluate(direct_emission(Distribution::kCauchy, masking, vacuum), {}).front();
      EXPECT_NEAR(d.direct_i, c, d.direct_i_error);
      EXPECT_NEAR(d.direct_q, 0.0, d.direct_q_error);
      EXPECT_LT(d.direct_i_error, 2e-4);
    }
  }
}

TEST_P(Grooves, WithoutAndWithTheDirectEmission_TheOtherMomentsAgree) {
  for (const Masking masking : kDirectMaskings) {
    const MomentsRequest with = direct_emission(Distribution::kCauchy, masking, {{70.0, {0.4, 2.5}, {3.0, 4.0}}});
    MomentsRequest without = with;
    without.wants_direct = false;
    const Moments a = evaluator_->evaluate(with, {}).front();
    const Moments b = evaluator_->evaluate(without, {}).front();
    expect_within_bounds(a, b, to_name({Distribution::kCauchy, masking}));
    EXPECT_TRUE(std::isnan(b.direct_i));
    // The emissivity is deficit / cos(theta) with single scattering, and direct_i / cos(theta) with direct emission.
    // The first is too high: it counts light that meets a second facet as absorbed. The second is too low: it leaves
    // out emission that other facets reflect.
    EXPECT_LE(a.direct_i, a.deficit);
  }
}

std::vector<Point> drawn(Domain domain, Distribution distribution, Masking masking, std::uint64_t seed) {
  Draws draw(seed);
  std::vector<Point> points;
  for (int i = 0; i < 20; ++i) {
    const MomentsPoint entry = random_entry(draw, domain, distribution, masking);
    points.push_back({entry.theta_deg, entry.shape, entry.index.index});
  }
  return points;
}

TEST(DirectEmission, RandomEntries_AreWithinTheBoundsOfTheReference) {
  for (const Distribution distribution : kDistributions) {
    for (const Masking masking : kDirectMaskings) {
      std::vector<Point> points = drawn(Domain::kOrdinary, distribution, masking, 12);
      for (const Point& point : drawn(Domain::kCorners, distribution, masking, 13)) points.push_back(point);
      const MomentsRequest request = direct_emission(distribution, masking, points);
      const std::vector<Moments> own = make_evaluator(Kernel::kCpuDouble)->evaluate(request, {});
      const std::vector<Moments> other = ReferenceEvaluator({.relative_tolerance = 1e-6}).evaluate(request, {});
      for (std::size_t i = 0; i < own.size(); ++i) expect_within_bounds(own[i], other[i], text_of(points[i]));
    }
  }
}

// ---- pBRDF ---------------------------------------------------------------------------------------------------------

ScatteringRequest bounces_of(const std::vector<ScatteringPoint>& points) {
  ScatteringRequest request = request_of(Distribution::kCauchy, Masking::kVCavity, points);
  request.scattering = Scattering::kMultiple;
  return request;
}

const std::vector<ScatteringPoint> kBeams = {{{40.0, 20.0, 180.0}, {0.3, 2.0}, {1.5, 0.1}},
                                             {{40.0, 20.0, 75.0}, {0.5, 2.5}, {10.0, 60.0}},
                                             {{10.0, 70.0, -130.0}, {0.4, 3.0}, {3.0, 4.0}},
                                             {{65.0, 64.0, 20.0}, {0.6, 2.0}, {26.0, 90.0}},
                                             {{0.0, 50.0, 30.0}, {0.5, 2.0}, {10.0, 60.0}},
                                             {{80.0, 75.0, 170.0}, {0.2, 1.5}, {1.33, 0.02}},
                                             {{50.0, 50.0, 0.0}, {0.5, 3.0}, {3.0, 4.0}},
                                             {{40.0, 20.0, 75.0}, {0.5, 2.5, 0.2, 35.0}, {10.0, 60.0}},
                                             {{65.0, 30.0, 160.0}, {0.2, 3.0, 0.5, -70.0}, {1.5, 0.1}}};

/// Compares Mueller matrices with the reference, except where the reference gives NaN. `rounding` is the allowed
/// rounding error of an element, divided by the element m00.
void expect_like_reference(ModelEvaluator& evaluator, const std::vector<ScatteringPoint>& points, double rounding) {
  const std::vector<ScatteringMatrix> computed = evaluator.scatter(bounces_of(points), {});
  const std::vector<ScatteringMatrix> exact = ReferenceEvaluator().scatter(bounces_of(points), {});
  for (std::size_t i = 0; i < computed.size(); ++i) {
    if (std::isnan(exact[i].m[0])) continue;
    const double bound = computed[i].error + exact[i].error + rounding * computed[i].m[0];
    for (std::size_t j = 0; j < computed[i].m.size(); ++j)
      EXPECT_NEAR(computed[i].m[j], exact[i].m[j], bound) << text_of(points[i]) << " element " << j;
  }
}

TEST_P(Grooves, MuellerMatrices_AreThoseOfTheReference) {
  expect_like_reference(*evaluator_, kBeams, 0.0);
  for (const ScatteringMatrix& f : evaluator_->scatter(bounces_of(kBeams), {})) EXPECT_LT(f.error, 3e-5 * f.m[0]);
}

TEST_P(Grooves, TowardTheMirrorDirection_NoMatrixIsDefined) {
  const ScatteringRequest mirror = bounces_of({{{40.0, 40.0, 180.0}, {0.3, 2.0}, {1.5, 0.1}}});
  const ScatteringMatrix matrix = evaluator_->scatter(mirror, {}).front();
  for (const double element : matrix.m) EXPECT_TRUE(std::isnan(element));
}

INSTANTIATE_TEST_SUITE_P(EveryKernel, Grooves, testing::ValuesIn(kKernels),
                         [](const auto& test) { return to_name(test.param); });

/// Beams that arrive at 40 degrees and leave 1e-6 to 1 degree beside the mirror direction, on several sides.
std::vector<BeamAngles> toward_the_mirror() {
  std::vector<BeamAngles> angles;
  for (const double away_deg : {1.0, 1e-2, 1e-6}) {
    angles.push_back({40.0, 40.0 + away_deg, 180.0});
    angles.push_back({40.0, 40.0 + 0.3 * away_deg, 180.0 - away_deg});
    angles.push_back({40.0, 40.0, 180.0 + away_deg});
  }
  return angles;
}

int most_bounces_toward_the_mirror(Distribution distribution, const OpticalConstants& index) {
  int most = 0;
  for (const BeamAngles& angles : toward_the_mirror()) {
    ScatteringRequest request = bounces_of({{angles, {0.3, 2.02}, index}});
    request.distribution = distribution;
    ScatteringMatrix f;
    request.accuracy = 1e-5;
    most = std::max(most, add_further_bounces(f, request, request.entries.front()));
  }
  return most;
}

// A metal reflects so strongly that the program follows beams of k = 2, 3, ..., 1,000 bounces. There are two beams for
// each k, and each beam has k bounces. So the program computes about 1e6 bounces. A bounce takes about 50 ns.
TEST(GroovesMueller, TowardTheMirrorDirection_WorkIsBounded) {
  for (const Distribution distribution : {Distribution::kCauchy, Distribution::kGaussian}) {
    const int paint = most_bounces_toward_the_mirror(distribution, {1.5, 0.1});
    const int metal = most_bounces_toward_the_mirror(distribution, {10.0, 60.0});
    std::printf("%s: paint %d, metal %d\n", to_name(distribution), paint, metal);
    EXPECT_LT(paint, 1'000);
    EXPECT_LT(metal, 1'010'000);
  }
}

TEST(GroovesMueller, TowardTheMirrorDirection_SumsAreThoseOfTheReference) {
  constexpr double kPrinted = 1e-15;  // allowed rounding error divided by m00: about the last decimal digit of a double
  for (const OpticalConstants& index : {OpticalConstants{1.5, 0.1}, OpticalConstants{3.0, 4.0}}) {
    std::vector<ScatteringPoint> points;
    for (const BeamAngles& angles : toward_the_mirror()) points.push_back({angles, {0.3, 2.02}, index});
    FixedPrecision evaluator(Precision::kDouble);
    expect_like_reference(evaluator, points, kPrinted);
  }
}

// ---- Scenes --------------------------------------------------------------------------------------------------------

SceneValues metal(const std::vector<std::string>& overrides) {
  return parse_scene(kRoughMetal, "s.toml", settings_from_text(overrides));
}

std::vector<PointResult> results_of(const SceneValues& scene, const SceneEntries& entries) {
  return evaluate_scene(scene, entries, *make_evaluator(Kernel::kCpuDouble), {});
}

PointResult result_at(const SceneValues& scene, const Point& point) {
  return results_of(scene, {{point.theta_deg, point.shape, point.index}}).front();
}

SceneValues multiple(Distribution distribution) {
  return metal({"surface.scattering=multiple", std::string("surface.distribution=") + to_name(distribution)});
}

double mean_emissivity(const PointResult& r) { return 0.5 * (r[Quantity::kEmissivityS] + r[Quantity::kEmissivityP]); }

TEST(GrooveScenes, RandomEntriesUpToTheHorizon_ArePhysical) {
  constexpr double kRounding = 1e-6;
  for (const Distribution distribution : kDistributions) {
    std::vector<Point> points = random_points(distribution);
    for (std::size_t i = 0; i < points.size(); i += 6) points[i].theta_deg = i % 12 == 0 ? 90.0 : kNextToTheHorizon;
    SceneValues scene = multiple(distribution);
    scene.accuracy.tolerance = 1e-2;
    const auto kernel = make_evaluator(Kernel::kCpuDouble);
    RememberingEvaluator evaluator(*kernel, [](const MomentsRequest&) { return true; });
    for (const Point& point : points) {
      const std::string where = text_of(point);
      for (const auto& surroundings : {std::optional<Surroundings>(), std::optional(Surroundings{400.0})}) {
        scene.surroundings = surroundings;
        const SceneEntries entries = {{point.theta_deg, point.shape, point.index}};
        const PointResult r = evaluate_scene(scene, entries, evaluator, {}).front();
        EXPECT_EQ(r.status & (kReflectanceOutsideZeroToOne | kIntensityNotPositive | kOutsideModelDomain), 0U) << where;
        EXPECT_NEAR(r[Quantity::kAlbedo], 1.0, kRounding) << where;
        EXPECT_TRUE(r[Quantity::kRhoI] >= 0.0 && r[Quantity::kRhoI] <= 1.0 + kRounding)
            << where << " rho_I " << r[Quantity::kRhoI];
        EXPECT_LE(std::abs(r[Quantity::kRhoQ]), r[Quantity::kRhoI] * (1.0 + kRounding)) << where;
        EXPECT_LE(std::abs(r[Quantity::kStokesQ]), r[Quantity::kStokesI]) << where;
        EXPECT_GT(r[Quantity::kStokesI], 0.0) << where;
        for (const double emissivity : {r[Quantity::kEmissivityS], r[Quantity::kEmissivityP]}) {
          EXPECT_TRUE(emissivity >= -kRounding && emissivity <= 1.0 + kRounding) << where << " eps " << emissivity;
        }
        EXPECT_NEAR(mean_emissivity(r) + r[Quantity::kRhoI], 1.0, kRounding) << where;
      }
    }
  }
}

// README.md states this emissivity and this DOLP, rounded. Single scattering would give 0.114 and 3.8 %.
TEST(GrooveScenes, RoughMetal_HasTheEmissivityAndDolpOfTheManual) {
  const PointResult r = result_at(multiple(Distribution::kGaussian), {60.0, {0.3, 2.0}, {10.0, 60.0}});
  EXPECT_NEAR(mean_emissivity(r), 0.01635, 1e-5);
  EXPECT_NEAR(r[Quantity::kDolp], 0.3892, 1e-4);
}

// At 90 degrees rho is a limit. It must agree with a stored value for a direction 1e-9 degrees below 90 degrees.
TEST(GrooveScenes, RightAngle_IsTheLimitOfTheStoredValue) {
  constexpr double kApproach = 1e-7;
  for (const StoredCase& c : stored_cases()) {
    if (!c.name.starts_with("grazing-limit")) continue;
    const PointResult at_90 = result_at(multiple(c.distribution), {90.0, c.shape, c.index});
    const double rho_i = c.moments.r_i / cos_sin_deg(c.theta_deg).cos;
    const double rho_q = c.moments.r_q / cos_sin_deg(c.theta_deg).cos;
    EXPECT_NEAR(at_90[Quantity::kRhoI], rho_i, (at_90[Quantity::kRhoErrorEstimate] + kApproach) * rho_i) << c.name;
    EXPECT_NEAR(at_90[Quantity::kRhoQ], rho_q, (at_90[Quantity::kRhoErrorEstimate] + kApproach) * rho_i) << c.name;
  }
}

TEST(GrooveScenes, SmoothSurface_IsThatOfSingleScattering) {
  for (const double theta_deg : {0.0, 60.0, 85.0}) {
    for (const OpticalConstants index : {OpticalConstants{1.5, 0.0}, {10.0, 60.0}, {0.7, 0.0}}) {
      const PointResult smooth = result_at(multiple(Distribution::kGaussian), {theta_deg, {0.0, 2.0}, index});
      const PointResult single = result_at(metal({}), {theta_deg, {0.0, 2.0}, index});
      EXPECT_EQ(smooth[Quantity::kRhoI], single[Quantity::kRhoI]);
      EXPECT_EQ(smooth[Quantity::kRhoQ], single[Quantity::kRhoQ]);
    }
  }
}

// The bracket (shaders/physics/README.md, section 3) is a range of DOLP in which the DOLP with all bounces must lie.
TEST(GrooveScenes, Bracket_IsWhatItsEndsSayAndHoldsAllBounces) {
  const std::vector<std::string> grid = {"grid.theta_deg=[0, 30, 60, 80]", "surroundings.temperature_K=250"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), grid.begin(), grid.end());
    const SceneValues scene = metal(more);
    return results_of(scene, grid_entries(scene));
  };
  const std::vector<PointResult> all = with({"surface.scattering=multiple"});
  const std::vector<PointResult> single = with({"emission.bracket=true"});
  const std::vector<PointResult> direct = with({"emission.bracket=true", "emission.model=direct"});
  constexpr double kAccuracy = 1e-4;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double low = single[i][Quantity::kDolpLow], high = single[i][Quantity::kDolpHigh];
    EXPECT_NEAR(low, direct[i][Quantity::kDolpLow], kAccuracy);
    EXPECT_NEAR(high, direct[i][Quantity::kDolpHigh], kAccuracy);
    for (const PointResult& own : {all[i], single[i], direct[i]}) {
      EXPECT_TRUE(low <= own[Quantity::kDolp] + kAccuracy && own[Quantity::kDolp] <= high + kAccuracy) << i;
    }
    if (i == 0) continue;  // at theta = 0 nothing is polarised
    const double direct_q = 0.5 * std::abs(direct[i][Quantity::kEmissivityS] - direct[i][Quantity::kEmissivityP]);
    const double slack = mean_emissivity(single[i]) - mean_emissivity(direct[i]);
    // Q = N (eps_s - eps_p) / 2, where eps is an emissivity. N is the same in all scenes of this test. With single
    // scattering (eps_s - eps_p) / 2 = -rho_Q.
    const double net = std::abs(single[i][Quantity::kStokesQ] / single[i][Quantity::kRhoQ]);
    EXPECT_NEAR(high, net * (direct_q + slack) / single[i][Quantity::kStokesI], kAccuracy);
    EXPECT_NEAR(low, net * std::max(direct_q - slack, 0.0) / single[i][Quantity::kStokesI], kAccuracy);
  }
}

}  // namespace
}  // namespace dolp::grooves_test
