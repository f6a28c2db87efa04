// With which precision and rule an entry is tried, and tried again where it misses the tolerance; and that whole runs
// do so for the entries that miss, and for no others.
#include "plan/refinement.hpp"
#include "model/angles.hpp"
#include "model/status.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "run/scene_run.hpp"

namespace dolp {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-12;  // of a power of ten, relative

// Where a float's rounding, some 2^-24 times 20 terms, leaves nothing for a rule.
constexpr double kInFloat = 1e-5;
constexpr double kInDouble = 1e-6;

constexpr double kTightestRule = 1e-15;

Accuracy accuracy(double tolerance, Precision precision = Precision::kAuto) {
  Accuracy result;
  result.tolerance = tolerance;
  result.precision = precision;
  return result;
}

// A result that misses a tolerance by a factor.
PointResult missed(double tolerance, double factor) {
  PointResult result{};
  result.status = kStatusToleranceMissed;
  result.error_estimate = 0.1 * factor * tolerance;
  result.rho_error_estimate = factor * tolerance;
  return result;
}

void expect_level(const std::optional<RefinementLevel>& level, Precision precision, double tolerance) {
  ASSERT_TRUE(level.has_value());
  EXPECT_EQ(level->precision, precision);
  EXPECT_NEAR(level->tolerance, tolerance, kRounding * tolerance);
}

// ---- One entry -----------------------------------------------------------------------------------------------------

TEST(FirstAttempt, Auto_IsFloatWhereItsRoundingLeavesRoom) {
  for (const double tolerance : {1e-2, 1e-4, kInFloat}) {
    expect_level(first_level(accuracy(tolerance), true), Precision::kFloat, tolerance);
  }
  for (const double tolerance : {kInDouble, 1e-8, 1e-10}) {
    expect_level(first_level(accuracy(tolerance), true), Precision::kDouble, tolerance);
  }
}

TEST(FirstAttempt, PrecisionOfTheScene_IsKept) {
  expect_level(first_level(accuracy(1e-2, Precision::kDouble), true), Precision::kDouble, 1e-2);
  expect_level(first_level(accuracy(1e-9, Precision::kFloat), true), Precision::kFloat, 1e-9);
}

TEST(FirstAttempt, WithoutDouble_IsFloat) { expect_level(first_level(accuracy(1e-9), false), Precision::kFloat, 1e-9); }

TEST(NextAttempt, MetTolerance_NeedsNone) {
  PointResult met = missed(1e-4, 0.9);
  met.status = 0;
  EXPECT_FALSE(next_level({Precision::kFloat, 1e-4}, met, accuracy(1e-4), true));
  met.status = kStatusUnphysicalReflectance;
  EXPECT_FALSE(next_level({Precision::kFloat, 1e-4}, met, accuracy(1e-4), true));
}

TEST(NextAttempt, OutsideTheDomain_NeedsNone) {
  PointResult outside = missed(1e-4, 100.0);
  outside.status |= kStatusOutsideDomain;
  outside.error_estimate = kNaN;
  EXPECT_FALSE(next_level({Precision::kFloat, 1e-4}, outside, accuracy(1e-4), true));
}

// At 90 degrees rho may diverge while the DOLP has a limit.
TEST(NextAttempt, OutsideTheDomainWithALimitOfTheDolp_LooksAtThatAlone) {
  PointResult outside = missed(1e-4, 50.0);
  outside.status |= kStatusOutsideDomain;
  outside.rho_error_estimate = kNaN;
  expect_level(next_level({Precision::kFloat, 1e-4}, outside, accuracy(1e-4), true), Precision::kFloat, 1e-5);
}

// An entry misses by its worse estimate; a rule that is as much tighter, and a little more, is tried next.
TEST(NextAttempt, Decades_FollowTheMiss) {
  struct Row {
    double factor;
    double decades;
  };
  for (const auto& [factor, decades] : {Row{1.01, 0.5}, Row{2.0, 0.5}, Row{5.0, 1}, Row{9.0, 1.5}, Row{50.0, 2},
                                        Row{200.0, 2.5}, Row{500.0, 3}, Row{5e3, 4}, Row{5e4, 5}, Row{1e9, 5}}) {
    const double tolerance = 1e-2;
    const double wanted = tolerance * std::pow(10.0, -decades);
    for (const bool dolp_is_worse : {false, true}) {
      PointResult result = missed(tolerance, factor);
      if (dolp_is_worse) std::swap(result.error_estimate, result.rho_error_estimate);
      const Precision precision = wanted >= kInFloat ? Precision::kFloat : Precision::kDouble;
      expect_level(next_level({Precision::kFloat, tolerance}, result, accuracy(tolerance), true), precision, wanted);
    }
  }
}

TEST(NextAttempt, NoEstimate_IsAMissByTheMost) {
  for (const double unknown : {kNaN, kInfinity}) {
    PointResult result = missed(1e-6, 1.0);
    result.error_estimate = unknown;
    expect_level(next_level({Precision::kDouble, 1e-6}, result, accuracy(1e-6), true), Precision::kDouble, 1e-11);
  }
}

TEST(NextAttempt, NoEstimateOfRho_IsAMissByTheMost) {
  PointResult result = missed(1e-6, 1.0);
  result.rho_error_estimate = kNaN;
  expect_level(next_level({Precision::kDouble, 1e-6}, result, accuracy(1e-6), true), Precision::kDouble, 1e-11);
}

// The decades are counted from the rule of the last level, not from the scene's tolerance.
TEST(NextAttempt, SecondMiss_GoesOnFromTheLastRule) {
  const Accuracy wanted = accuracy(1e-3);
  expect_level(next_level({Precision::kFloat, 1e-4}, missed(1e-3, 5.0), wanted, true), Precision::kFloat, 1e-5);
  // after four decades the next step is two at least
  expect_level(next_level({Precision::kDouble, 1e-7}, missed(1e-3, 5.0), wanted, true), Precision::kDouble, 1e-9);
}

TEST(NextAttempt, RuleTooTightForFloat_GoesOnInDouble) {
  expect_level(next_level({Precision::kFloat, 1e-5}, missed(1e-5, 5.0), accuracy(1e-5), true), Precision::kDouble,
               1e-6);
  // without double, up to where float can go
  for (const auto& [wanted, has_double] :
       {std::pair{accuracy(1e-5), false}, std::pair{accuracy(1e-5, Precision::kFloat), true}}) {
    expect_level(next_level({Precision::kFloat, 1e-5}, missed(1e-5, 5.0), wanted, has_double), Precision::kFloat, 2e-6);
    EXPECT_FALSE(next_level({Precision::kFloat, 2e-6}, missed(1e-5, 5.0), wanted, has_double));
  }
}

TEST(NextAttempt, DoubleNeverGoesBackToFloat) {
  expect_level(next_level({Precision::kDouble, 1e-2}, missed(1e-2, 5.0), accuracy(1e-2, Precision::kDouble), true),
               Precision::kDouble, 1e-3);
}

TEST(NextAttempt, TightestRule_IsTheLast) {
  expect_level(next_level({Precision::kDouble, 1e-13}, missed(1e-10, 1e3), accuracy(1e-10), true), Precision::kDouble,
               kTightestRule);
  EXPECT_FALSE(next_level({Precision::kDouble, kTightestRule}, missed(1e-10, 1e3), accuracy(1e-10), true));
}

// Whatever the results, the levels get costlier and end.
TEST(Levels, EntryThatAlwaysMisses_EndsSoon) {
  constexpr int kMost = 12;  // steps that grow by half, and the change to double
  for (const bool has_double : {false, true}) {
    for (const Precision precision : {Precision::kAuto, Precision::kFloat, Precision::kDouble}) {
      for (int exponent = 2; exponent <= 10; ++exponent) {
        for (const double factor : {1.001, 30.0, 1e8, kNaN}) {
          const Accuracy wanted = accuracy(std::pow(10.0, -exponent), precision);
          RefinementLevel last = first_level(wanted, has_double);
          int count = 1;
          while (const auto next = next_level(last, missed(wanted.tolerance, factor), wanted, has_double)) {
            EXPECT_TRUE(last < *next);
            EXPECT_FALSE(*next < last);
            EXPECT_LT(next->tolerance, last.tolerance);
            EXPECT_GE(next->tolerance, kTightestRule);
            EXPECT_TRUE(has_double || next->precision == Precision::kFloat);
            last = *next;
            ASSERT_LE(++count, kMost);
          }
          if (has_double && precision != Precision::kFloat) {
            EXPECT_EQ(last.precision, Precision::kDouble);
            EXPECT_NEAR(last.tolerance, kTightestRule, kRounding * kTightestRule);
          } else {
            EXPECT_EQ(last.precision, Precision::kFloat);
          }
        }
      }
    }
  }
}

// ---- Whole runs ----------------------------------------------------------------------------------------------------

constexpr double kTolerance = 1e-4;
constexpr double kWorsensFrom_deg = 50.0;

// Moments whose errors keep to the request's tolerance up to kWorsensFrom_deg and miss it by `factor` beyond; in double
// they keep to it everywhere unless it `never_meets`.
class Scripted final : public MomentsEvaluator {
 public:
  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress&) override {
    requests.push_back(request);
    std::vector<Moments> results;
    for (std::size_t i = 0; i < request.size(); ++i) {
      const double theta_deg = request[i].theta_deg;
      const double cosine = cos_sin_deg(theta_deg).cos;
      const bool misses = theta_deg > kWorsensFrom_deg && (never_meets || request.precision == Precision::kFloat);
      Moments m;
      m.r_i = 0.2 * cosine;
      m.r_q = 0.1 * cosine * (1.0 + shift * static_cast<double>(requests.size() - 1));
      m.albedo = cosine;
      m.deficit = cosine - m.r_i;
      m.r_i_error = m.r_q_error = m.deficit_error = (misses ? factor : 0.01) * kTolerance * m.r_i;
      if (misses && worsens) m.r_i_error *= static_cast<double>(requests.size());
      results.push_back(m);
    }
    return results;
  }
  bool has_double() const override { return double_precision; }
  EvaluationReport report() const override { return {}; }

  std::vector<MomentsRequest> requests;
  double factor = 50.0;
  double shift = 1e-3;
  bool double_precision = true;
  bool never_meets = false;
  bool worsens = false;
};

Scene scene() {
  Scene result;
  result.surface.material.constant = {1.508, 0.0};
  result.surface.masking = Masking::kNone;
  result.emission = Emission{300.0, EmissionModel::kMoments};
  result.spectrum = {10.6, 10.6};
  result.accuracy.tolerance = kTolerance;
  return result;
}

const std::vector<SceneEntry> kEntries = {
    {20.0, {0.3, 2.0}, {}}, {60.0, {0.3, 2.0}, {}}, {40.0, {0.3, 2.0}, {}}, {70.0, {0.2, 2.0}, {}}};
const std::vector<double> kMissingDeg = {60.0, 70.0};

TEST(EvaluateScene_Levels, OnlyTheEntriesThatMiss_AreComputedAgain) {
  Scripted evaluator;
  const std::vector<PointResult> results = evaluate_scene(scene(), kEntries, evaluator, {});
  ASSERT_EQ(evaluator.requests.size(), 2U);
  EXPECT_EQ(evaluator.requests[0].size(), 4U);
  EXPECT_EQ(evaluator.requests[0].precision, Precision::kFloat);
  EXPECT_EQ(evaluator.requests[0].tolerance, kTolerance);
  EXPECT_EQ(evaluator.requests[1].theta_deg, kMissingDeg);
  EXPECT_EQ(evaluator.requests[1].precision, Precision::kDouble);
  EXPECT_NEAR(evaluator.requests[1].tolerance, 0.01 * kTolerance, kRounding * kTolerance);
  ASSERT_EQ(results.size(), kEntries.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    EXPECT_EQ(results[i].status & kStatusToleranceMissed, 0U) << i;
    // in its own place, from the level that met the tolerance
    const double rho_q = kEntries[i].theta_deg > kWorsensFrom_deg ? 0.1 * (1.0 + evaluator.shift) : 0.1;
    EXPECT_NEAR(results[i].rho_q, rho_q, 1e-12) << i;
  }
}

/// Misses at two entries in float, or at all of their directions.
class MissesTwo final : public MomentsEvaluator {
 public:
  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override {
    requests.push_back(request);
    std::vector<Moments> moments = own_.evaluate(request, progress);
    for (std::size_t i = 0; i < moments.size(); ++i) {
      const MomentsPoint point = request[i];
      const bool misses = (point.theta_deg == 60.0 && (misses_all || point.shape.sigma == 0.2)) ||
                          (point.theta_deg == 40.0 && (misses_all || point.shape.sigma == 0.3));
      const double factor = misses && request.precision == Precision::kFloat ? 50.0 : 0.01;
      Moments& m = moments[i];
      m.r_i_error = m.r_q_error = m.deficit_error = factor * kTolerance * m.r_i;
    }
    return moments;
  }
  EvaluationReport report() const override {
    EvaluationReport report;
    report.interpolation_nodes = interpolates ? requests.size() : 0;
    return report;
  }
  bool interpolates = true;
  bool misses_all = false;  ///< of the two directions
  std::vector<MomentsRequest> requests;

 private:
  Scripted own_;
};

// A grid stays one: what meets the tolerance is masked out, and the slope distributions stay as they are.
TEST(EvaluateScene_Levels, FewEntriesOfADirectionMiss_AskedForUnderAMask) {
  MissesTwo evaluator;
  const SceneEntries grid =
      SceneEntries::grid({20.0, 40.0, 60.0}, {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0}, {2.0});
  evaluate_scene(scene(), grid, evaluator, {});
  ASSERT_GE(evaluator.requests.size(), 2U);
  EXPECT_EQ(evaluator.requests[0].size(), 30U);
  EXPECT_TRUE(evaluator.requests[0].wanted.empty());
  EXPECT_TRUE(evaluator.requests[0].may_interpolate);
  const MomentsRequest& again = evaluator.requests.back();
  EXPECT_EQ(again.theta_deg, (std::vector{40.0, 60.0}));
  EXPECT_EQ(again.sigma, grid.sigma());
  EXPECT_EQ(again.wanted_count(), 2U);
  EXPECT_NE(again.wanted[2], 0);       // 40 degrees, sigma 0.3
  EXPECT_NE(again.wanted[10 + 1], 0);  // 60 degrees, sigma 0.2
  EXPECT_FALSE(again.may_interpolate);
}

// Interpolation spares most of a direction again, but only where it did so before.
TEST(EvaluateScene_Levels, ManyEntriesOfAnInterpolatedDirectionMiss_AllOfItIsAskedFor) {
  for (const bool interpolates : {true, false}) {
    MissesTwo evaluator;
    evaluator.interpolates = interpolates;
    evaluator.misses_all = true;
    std::vector<double> sigma(64);
    for (std::size_t i = 0; i < sigma.size(); ++i) sigma[i] = 0.1 + 0.01 * static_cast<double>(i);
    evaluate_scene(scene(), SceneEntries::grid({20.0, 40.0, 60.0}, sigma, {2.0}), evaluator, {});
    ASSERT_GE(evaluator.requests.size(), 2U);
    const MomentsRequest& again = evaluator.requests.back();
    EXPECT_EQ(again.theta_deg, (std::vector{40.0, 60.0}));
    EXPECT_EQ(again.size(), 128U);
    EXPECT_TRUE(again.wanted.empty());
    EXPECT_EQ(again.may_interpolate, interpolates);
  }
}

TEST(EvaluateScene_Levels, WithoutDouble_TheMissStandsAndSaysSo) {
  Scripted evaluator;
  evaluator.double_precision = false;
  const std::vector<PointResult> results = evaluate_scene(scene(), kEntries, evaluator, {});
  for (const MomentsRequest& request : evaluator.requests) EXPECT_EQ(request.precision, Precision::kFloat);
  EXPECT_NE(results[1].status & kStatusToleranceMissed, 0U);
  EXPECT_EQ(results[2].status & kStatusToleranceMissed, 0U);
}

TEST(EvaluateScene_Levels, ThatAllMiss_KeepTheBest) {
  Scripted evaluator;
  evaluator.never_meets = true;
  evaluator.worsens = true;
  const std::vector<PointResult> results = evaluate_scene(scene(), kEntries, evaluator, {});
  EXPECT_GT(evaluator.requests.size(), 2U);
  EXPECT_NE(results[1].status & kStatusToleranceMissed, 0U);
  EXPECT_NEAR(results[1].rho_q, 0.1, 1e-12);  // of the first level
}

// Entries that miss by more than others want a tighter rule, and are not held back by them.
TEST(EvaluateScene_Levels, EachRuleAndPrecision_IsAskedForOnce) {
  Scripted evaluator;
  evaluator.never_meets = true;
  evaluate_scene(scene(), kEntries, evaluator, {});
  for (std::size_t i = 1; i < evaluator.requests.size(); ++i) {
    const RefinementLevel before{evaluator.requests[i - 1].precision, evaluator.requests[i - 1].tolerance};
    const RefinementLevel now{evaluator.requests[i].precision, evaluator.requests[i].tolerance};
    EXPECT_TRUE(before < now) << i;
  }
  EXPECT_EQ(evaluator.requests.back().precision, Precision::kDouble);
}

TEST(EvaluateScene_Levels, Mirror_IsNeverTriedAgain) {
  Scripted evaluator;
  const std::vector<SceneEntry> mirror = {{60.0, {0.0, 2.0}, {}}};
  evaluate_scene(scene(), mirror, evaluator, {});
  for (const MomentsRequest& request : evaluator.requests) EXPECT_EQ(request.size(), 0U);
}

TEST(EvaluateScene_Levels, TightTolerance_StartsInDouble) {
  Scripted evaluator;
  Scene tight = scene();
  tight.accuracy.tolerance = 1e-8;
  evaluate_scene(tight, {kEntries[0]}, evaluator, {});
  EXPECT_EQ(evaluator.requests.front().precision, Precision::kDouble);
}

/// Moments whose check differs from them by a multiple of both their bounds.
class Contradicts final : public MomentsEvaluator {
 public:
  explicit Contradicts(double bounds) : bounds_(bounds) {}
  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress&) override {
    std::vector<Moments> moments(request.size());
    for (std::size_t i = 0; i < moments.size(); ++i) {
      const double cosine = cos_sin_deg(request[i].theta_deg).cos;
      Moments& m = moments[i];
      m = {.r_i = 0.2 * cosine, .r_q = 0.1 * cosine, .albedo = cosine, .deficit = 0.8 * cosine};
      m.r_i_error = m.r_q_error = m.deficit_error = 0.01 * kTolerance * m.r_i;
      if (request.has_extra_splits) m.r_q += bounds_ * 2.0 * m.r_q_error;
    }
    checks += request.has_extra_splits ? 1 : 0;
    wanted_direct |= request.wants_direct;
    return moments;
  }
  EvaluationReport report() const override { return {}; }

  int checks = 0;
  bool wanted_direct = false;

 private:
  double bounds_;
};

SelfCheck checked(Contradicts& evaluator, std::vector<PointResult>& results, const Scene& of = scene()) {
  std::vector<double> theta_deg(40), sigma(20);
  for (std::size_t i = 0; i < theta_deg.size(); ++i) theta_deg[i] = static_cast<double>(i);
  for (std::size_t i = 0; i < sigma.size(); ++i) sigma[i] = 0.1 + 0.01 * static_cast<double>(i);
  const SceneEntries grid = SceneEntries::grid(theta_deg, sigma, {2.0});
  CollectedResults collected(grid);
  const SelfCheck check = run_scene(of, grid, keep_everything(of), &evaluator, collected, {});
  results = collected.take();
  return check;
}

TEST(RunScene_SelfCheck, WithinTheBounds_ChangesNothing) {
  Contradicts evaluator(0.5);
  std::vector<PointResult> results;
  const SelfCheck check = checked(evaluator, results);
  EXPECT_EQ(evaluator.checks, 1);
  EXPECT_GT(check.entries, 0U);
  EXPECT_GT(check.worst_ratio, 0.3);
  EXPECT_LT(check.worst_ratio, 1.0);
  for (const PointResult& result : results) EXPECT_EQ(result.status, 0U);
}

TEST(RunScene_SelfCheck, MaskingWithADirectEmission_AsksForTheKernelOfTheRun) {
  Contradicts evaluator(0.5);
  std::vector<PointResult> results;
  Scene smith = scene();
  smith.surface.masking = Masking::kSmith;
  checked(evaluator, results, smith);
  EXPECT_EQ(evaluator.checks, 1);
  EXPECT_FALSE(evaluator.wanted_direct);
}

TEST(RunScene_SelfCheck, BeyondTheBounds_NoEntryOfTheDirectionMeetsTheTolerance) {
  Contradicts evaluator(3.0);
  std::vector<PointResult> results;
  const SelfCheck check = checked(evaluator, results);
  EXPECT_GT(check.worst_ratio, 1.0);
  EXPECT_LT(check.worst_ratio, 6.0);
  ASSERT_EQ(results.size(), 800U);
  constexpr std::size_t kDirections = 40;
  std::size_t missed = 0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    EXPECT_EQ(results[i].status, results[i - i % 20].status);  // of its direction
    missed += i % 20 == 0 && results[i].status == kStatusToleranceMissed ? 1 : 0;
  }
  EXPECT_GT(missed, 0U);
  EXPECT_LE(missed, std::min(kDirections, check.entries));
}

}  // namespace
}  // namespace dolp
