// A run keeps the best result that an entry gets in the refinement levels. It checks itself to find wrong bounds.
#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include <dolp/status.hpp>
#include "model/angles.hpp"
#include "moments_only.hpp"
#include "run/scene_run.hpp"

namespace dolp::levels_test {
namespace {

constexpr double kTolerance = 1e-4;

SceneValues scene() {
  SceneValues result;
  result.surface.material.constant = {1.508, 0.0};
  result.surface.masking = Masking::kNone;
  result.emission = Emission{300.0, EmissionModel::kMoments};
  result.spectrum = {10.6, 10.6};
  result.accuracy.tolerance = kTolerance;
  return result;
}

/// Moments that miss the tolerance, with errors that grow at each call.
class Worsens final : public MomentsOnly {
 public:
  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress&) override {
    ++calls;
    Moments m = {.r_i = 0.2, .r_q = 0.1 * calls, .albedo = 1.0, .deficit = 0.8};
    m.r_i_error = m.r_q_error = m.deficit_error = 50.0 * calls * kTolerance * m.r_i;
    return std::vector<Moments>(request.size(), m);
  }

  double calls = 0.0;
};

TEST(EvaluateScene_Levels, ThatWorsen_LeaveTheFirst) {
  Worsens evaluator;
  const PointResult result = evaluate_scene(scene(), {{0.0, {0.3, 2.0}, {}}}, evaluator, {}).front();
  EXPECT_GT(evaluator.calls, 1.0);
  EXPECT_EQ(result.status, kToleranceNotMet | kRhoToleranceNotMet);
  EXPECT_EQ(result[Quantity::kRhoQ], 0.1);
}

/// When the run checks itself, this evaluator returns a larger r_q than before. The two values of r_q differ by
/// `bounds` times the sum of their stated errors.
class Contradicts final : public MomentsOnly {
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

  int checks = 0;
  bool wanted_direct = false;

 private:
  double bounds_;
};

SelfCheck checked(Contradicts& evaluator, std::vector<PointResult>& results, const SceneValues& of = scene()) {
  std::vector<double> theta_deg(40), sigma(20);
  for (std::size_t i = 0; i < theta_deg.size(); ++i) theta_deg[i] = static_cast<double>(i);
  for (std::size_t i = 0; i < sigma.size(); ++i) sigma[i] = 0.1 + 0.01 * static_cast<double>(i);
  const SceneEntries grid = SceneEntries::grid(theta_deg, sigma, {2.0});
  CollectedResults collected(grid);
  const SelfCheck check = run_scene(of, grid, keep_everything(of), &evaluator, {collected.sink()}).check;
  results = collected.take().list();
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
  SceneValues smith = scene();
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
    EXPECT_EQ(results[i].status, results[i - i % 20].status);  // all entries of a direction have the same status
    missed += i % 20 == 0 && results[i].status == kAnyToleranceNotMet ? 1 : 0;
  }
  EXPECT_GT(missed, 0U);
  EXPECT_LE(missed, std::min(kDirections, check.entries));
}

}  // namespace
}  // namespace dolp::levels_test
