// The hard cases of the model: checks of the stored values, and all evaluators compared with them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include <dolp/errors.hpp>
#include <memory>
#include <string>
#include <vector>

#include <dolp/results.hpp>
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "properties_support.hpp"
#include "reference/moments.hpp"
#include "reference/reference_evaluator.hpp"
#include "run/scene_run.hpp"
#include "stored_evaluator.hpp"
#include "verify/qualification.hpp"

namespace dolp::hard_cases_test {
namespace {

std::string label(const StoredCase& c) {
  return std::string(to_name(c.distribution)) + " " + to_name(c.masking) + " " + c.name;
}

// ---- What is stored ------------------------------------------------------------------------------------------------

TEST(HardCases, References_AreAsGoodAsStated) {
  constexpr double kRelative = 1.5e-13;
  // In the case almost-vacuum, r_i is 3e-9. It is the square of amplitudes of 5e-5. The rounding errors of these
  // amplitudes are 1e-16, so the relative error of r_i is larger than usual.
  constexpr double kAlmostVacuum = 3e-11;
  for (const StoredCase& c : hard_cases()) {
    const Moments& m = c.moments;
    const double allowed = (c.name == "almost-vacuum" ? kAlmostVacuum : kRelative) * m.r_i;
    EXPECT_LE(m.r_i_error, allowed) << label(c);
    EXPECT_LE(m.r_q_error, allowed) << label(c);
    EXPECT_LE(m.albedo_error, kRelative * m.albedo) << label(c);
  }
}

Moments recomputed(const StoredCase& c, const reference::Refinement& options) {
  const MomentsRequest request = request_of({c.distribution, c.masking}, {{c.theta_deg, c.shape, c.index}}, 0.0);
  return ReferenceEvaluator(options).evaluate(request, {}).at(0);
}

// The test leaves out nine of ten cases with integral masking, because integral masking is slow.
TEST(HardCases, AnotherRefinement_StaysWithinTheErrors) {
  std::size_t of_integral = 0, of_others = 0;
  for (const StoredCase& c : hard_cases()) {
    if (c.masking == Masking::kIntegral ? of_integral++ % 40 != 0 : of_others++ % 3 != 0) continue;
    const Moments m = recomputed(c, {.relative_tolerance = 1e-8, .subdivisions = 3});
    EXPECT_NEAR(m.r_i, c.moments.r_i, m.r_i_error + c.moments.r_i_error) << label(c);
    EXPECT_NEAR(m.r_q, c.moments.r_q, m.r_q_error + c.moments.r_q_error) << label(c);
    EXPECT_NEAR(m.albedo, c.moments.albedo, m.albedo_error + c.moments.albedo_error) << label(c);
    EXPECT_NEAR(m.deficit, c.moments.deficit, m.deficit_error + c.moments.deficit_error) << label(c);
  }
}

// ---- Every evaluator against it ------------------------------------------------------------------------------------

class HardCasesOn : public testing::TestWithParam<Kernel> {};

// `dolp verify --hard-cases --precision double` and `dolp devices` report a precision. qualify() must really use it.
TEST(Qualify, EvaluatorInDouble_IsExaminedInDouble) {
  CpuEvaluator evaluator;
  qualify(cases_of(hard_cases(), Distribution::kCauchy, Masking::kNone), evaluator, {1e-2, Precision::kDouble}, {});
  EXPECT_EQ(evaluator.report().precision, "double");
}

TEST_P(HardCasesOn, EveryCase_IsWithinItsEstimateAndMeetsTheToleranceOrSaysSo) {
  const std::unique_ptr<ModelEvaluator> evaluator = make_evaluator(GetParam());
  const std::vector<StoredCase> cases = hard_cases();
  const std::vector tolerances = is_double(GetParam()) ? std::vector{1e-4, 1e-6, 1e-9} : std::vector{1e-2, 1e-4, 1e-6};
  for (const double tolerance : tolerances) {
    const std::vector<CaseOutcome> outcomes = qualify(cases, *evaluator, {tolerance}, {});
    ASSERT_EQ(outcomes.size(), cases.size());
    std::size_t missed = 0;
    for (const CaseOutcome& outcome : outcomes) {
      missed += (outcome.status & kAnyToleranceNotMet) != 0 ? 1 : 0;
      EXPECT_EQ(outcome.complaint, "") << label(outcome.stored) << ", tolerance " << tolerance << ": rho "
                                       << outcome.rho.error << " of " << outcome.rho.estimate << ", dolp "
                                       << outcome.dolp.error << " of " << outcome.dolp.estimate;
    }
    std::printf("%zu cases, %zu say that they miss %.0e\n", cases.size(), missed, tolerance);
  }
}

INSTANTIATE_TEST_SUITE_P(EveryKernel, HardCasesOn, testing::ValuesIn(kKernels),
                         [](const auto& test) { return to_name(test.param); });

// An evaluator that changes r_i by the share `bias` but states the error 1e-6. qualify() must notice a larger `bias`.
class BiasedEvaluator final : public MomentsOnly {
 public:
  explicit BiasedEvaluator(const std::vector<StoredCase>& cases) : stored_(cases) {}
  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override {
    std::vector<Moments> results = stored_.evaluate(request, progress);
    for (Moments& m : results) {
      m.r_i_error = m.r_q_error = m.deficit_error = 1e-6 * m.r_i;
      m.r_i *= 1.0 + bias;
      m.deficit -= bias * m.r_i;
    }
    return results;
  }
  double bias = 0.0;

 private:
  StoredEvaluator stored_;
};

TEST(Qualify, BiasedEvaluator_IsFoundOutCaseByCase) {
  std::vector<StoredCase> cases = cases_of(hard_cases(), Distribution::kCauchy, Masking::kIntegral);
  // Leaves out mirrors, which need no evaluator, and directions near 90 degrees, where rounding of cos(theta) counts.
  std::erase_if(cases, [](const StoredCase& c) { return c.shape.sigma == 0.0 || c.theta_deg > 89.9; });
  BiasedEvaluator evaluator(cases);
  for (const double bias : {0.0, 5e-7, 2e-6}) {
    evaluator.bias = bias;
    for (const CaseOutcome& outcome : qualify(cases, evaluator, {1e-4}, {})) {
      const StoredCase& stored = outcome.stored;
      const bool is_wrong = bias > 1e-6 && stored.moments.r_i > 0.0;
      EXPECT_EQ(!outcome.complaint.empty(), is_wrong) << label(stored) << " " << bias << " " << outcome.complaint;
    }
  }
}

// At 90 degrees, with v-cavity and smith masking, the program gives the limit of rho. The stored values are for
// 90 - 1e-9 degrees, where cos(theta) is 2e-11. So they differ from the limit by less than kApproach.
TEST(HardCases, RightAngle_IsTheLimitOfTheStoredValue) {
  constexpr double kApproach = 1e-8;
  for (const StoredCase& c : hard_cases()) {
    const bool has_limit = c.masking == Masking::kVCavity || c.masking == Masking::kSmith;
    if (!has_limit || !c.name.starts_with("grazing-limit")) continue;
    FixedPrecision evaluator(Precision::kDouble);
    const SceneValues scene = emission_scene(c.distribution, c.masking, 1e-4);
    const PointResult result = evaluate_scene(scene, {{90.0, c.shape, c.index}}, evaluator, {}).at(0);
    const double cosine = reference::zenith_from_deg(c.theta_deg).cos;
    const double rho_i = c.moments.r_i / cosine;
    EXPECT_NEAR(result[Quantity::kRhoI], rho_i, (result[Quantity::kRhoErrorEstimate] + kApproach) * rho_i) << label(c);
    EXPECT_NEAR(result[Quantity::kRhoQ], c.moments.r_q / cosine,
                (result[Quantity::kRhoErrorEstimate] + kApproach) * rho_i)
        << label(c);
  }
}

}  // namespace
}  // namespace dolp::hard_cases_test
