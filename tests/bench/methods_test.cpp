// The methods that dolp-bench compares with dolp are correct, converge as expected, and measure times as documented.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "error_text.hpp"
#include "methods/method.hpp"
#include "model/choices.hpp"
#include "reference/reference_evaluator.hpp"
#include "studies/cases.hpp"
#include "studies/context.hpp"
#include "studies/grids.hpp"
#include "studies/report.hpp"
#include "studies/timing.hpp"

namespace methods_test {

using namespace dolp;
using namespace dolp::bench;

/// Tolerance of the reference, relative to r_i. It is tighter than every tolerance in this file.
constexpr double kReferenceTolerance = 1e-9;

std::unique_ptr<Solver> solver_of(const std::string& name) {
  const auto found = std::ranges::find(methods(), name, &Method::name);
  if (found == methods().end()) throw std::out_of_range(name);
  return found->make({});
}

const Case& case_of(const std::string& name) {
  const auto found = std::ranges::find(cases(), name, &Case::name);
  if (found == cases().end()) throw std::out_of_range(name);
  return *found;
}

std::vector<Moments> truth_of(MomentsRequest request) {
  request.tolerance = 0.0;
  return ReferenceEvaluator({.relative_tolerance = kReferenceTolerance}).evaluate(request, nullptr);
}

double error_of(const Answer& answer, const Moments& truth) {
  return std::max(std::abs(answer.r_i - truth.r_i), std::abs(answer.r_q - truth.r_q)) / truth.r_i;
}

double worst_error(Solver& solver, const MomentsRequest& request, double setting, const std::vector<Moments>& truth) {
  const Solution solution = solver.solve(request, setting);
  EXPECT_EQ(solution.answers.size(), request.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < request.size(); ++i) worst = std::max(worst, error_of(solution.answers[i], truth[i]));
  return worst;
}

/// A setting that makes a method fast, and the largest error that each case may have with this setting.
struct Expected {
  double setting = 0.0;
  std::map<std::string, double> tolerance;
};

// The tolerances of midpoint and Gauss rules are two to three times an error that was measured at this setting. The
// tolerances of monte-carlo are four standard errors of 1e5 samples. hcubature and pcubature only estimate their
// errors, so their tolerances are ten times the setting. The tolerances of other methods are the setting itself.
const std::map<std::string, Expected> kExpected = {
    {"midpoint", {256, {{"easy", 8e-6}, {"median", 6e-6}, {"rough", 6e-5}, {"hard", 2e-3}, {"worst", 2e-2}}}},
    {"gauss", {64, {{"easy", 2e-9}, {"median", 4e-5}, {"rough", 2e-9}, {"hard", 1.5e-4}, {"worst", 2e-5}}}},
    {"vulkan-midpoint", {256, {{"easy", 8e-6}, {"median", 6e-6}, {"rough", 6e-5}, {"hard", 2e-3}, {"worst", 2e-2}}}},
    {"vulkan-gauss", {64, {{"easy", 1e-6}, {"median", 4e-5}, {"rough", 1e-6}, {"hard", 1.5e-4}, {"worst", 2e-5}}}},
    {"monte-carlo", {1e5, {{"easy", 1e-2}, {"median", 1e-2}, {"rough", 1.5e-2}, {"hard", 1.2e-2}, {"worst", 4e-2}}}},
    {"hcubature", {1e-6, {{"easy", 1e-5}, {"median", 1e-5}, {"rough", 1e-5}, {"hard", 1e-5}, {"worst", 1e-5}}}},
    {"pcubature", {1e-5, {{"easy", 1e-4}, {"median", 1e-4}, {"rough", 1e-4}, {"hard", 1e-4}, {"worst", 1e-4}}}},
    {"dblquad", {1e-2, {{"easy", 1e-2}, {"median", 1e-2}, {"rough", 1e-2}, {"hard", 1e-2}, {"worst", 1e-2}}}},
    {"vulkan-float", {1e-4, {{"easy", 1e-4}, {"median", 1e-4}, {"rough", 1e-4}, {"hard", 1e-4}, {"worst", 1e-4}}}},
    {"vulkan-double", {1e-5, {{"easy", 1e-5}, {"median", 1e-5}, {"rough", 1e-5}, {"hard", 1e-5}, {"worst", 1e-5}}}},
    {"cpu-float", {1e-4, {{"easy", 1e-4}, {"median", 1e-4}, {"rough", 1e-4}, {"hard", 1e-4}, {"worst", 1e-4}}}},
    {"cpu-double", {1e-5, {{"easy", 1e-5}, {"median", 1e-5}, {"rough", 1e-5}, {"hard", 1e-5}, {"worst", 1e-5}}}},
};

TEST(BenchMethods, EveryCase_CheapSetting_AgreesWithReference) {
  std::map<std::string, std::vector<Moments>> truth;
  for (const Case& one : cases()) truth[one.name] = truth_of(neighbourhood(one, 2));
  for (const Method& method : methods()) {
    const std::unique_ptr<Solver> solver = method.make({});
    const Expected& expected = kExpected.at(method.name);
    const std::size_t entries = method.name == "dblquad" ? 1 : 2;  // dblquad is slow
    for (const Case& one : cases()) {
      const double error = worst_error(*solver, neighbourhood(one, entries), expected.setting, truth[one.name]);
      EXPECT_LE(error, expected.tolerance.at(one.name)) << method.name << " " << one.name;
    }
    EXPECT_FALSE(solver->where().empty()) << method.name;
  }
}

// The tolerance is so tight that small errors would fail the test: errors of the masking tables, which `integral` and
// `smith` masking use, and errors of the integrand near the horizon, where the integral ends.
TEST(BenchFormulas, AdaptiveCubature_TightTolerance_AgreesWithReferenceForBothDistributions) {
  const std::unique_ptr<Solver> hcubature = solver_of("hcubature");
  for (const Distribution distribution : {Distribution::kCauchy, Distribution::kGaussian}) {
    for (const Masking masking : {Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith}) {
      SCOPED_TRACE(to_name(masking));
      MomentsRequest request;
      request.distribution = distribution;
      request.masking = masking;
      request.append({20.0, {0.3, 1.7}, {1.5, 0.1}});
      request.append({55.0, {0.9, 4.0}, {27.0, 90.0}});
      request.append({80.0, {0.3, 1.7}, {1.5, 0.1}});
      EXPECT_LE(worst_error(*hcubature, request, 1e-7, truth_of(request)), 1e-7);
    }
  }
}

TEST(BenchDblquad, NoPythonWithScipy_IsUnavailableAndSaysWhatToDo) {
  const std::string message = error_text<Unavailable>([&] {
    make_dblquad({.pythons = {"/bin/false", "/no/such/python"}});
  });
  EXPECT_EQ(message, "no Python with SciPy (tried /bin/false, /no/such/python); install python3-scipy");
}

TEST(BenchDblquad, TimeLimit_IsKept) {
  const std::unique_ptr<Solver> dblquad = make_dblquad({.time_limit_s = 0.05});
  EXPECT_THROW(dblquad->solve(neighbourhood(case_of("hard"), 1), 1e-8), TookTooLong);
}

TEST(BenchTiming, MedianAndSpread_OddAndEven_AreThoseOfTheList) {
  EXPECT_EQ(median({5.0, 1.0, 3.0}), 3.0);
  EXPECT_EQ(median({4.0, 1.0, 3.0, 2.0}), 2.5);
  EXPECT_EQ(minimum({4.0, 1.0, 3.0}), 1.0);
  EXPECT_DOUBLE_EQ(spread({1.0, 1.5, 9.0}), 0.5);
}

/// A study that causes no warning: one result, from an idle machine and a release build.
nlohmann::ordered_json quiet_study() {
  return {
      {"study", "test"},
      {"context",
       {{"machine", {{"load", 0.1}, {"cores", 2}}}, {"compiler", {{"build_type", "Release"}}}, {"validation", false}}},
      {"results", {{{"method", "gauss"}, {"case", "easy"}, {"setting", 16.0}, {"raw_times_s", {1.0, 1.1, 1.2}}}}}};
}

TEST(BenchReport, Warnings_BadConditions_EachSayWhatToDo) {
  nlohmann::ordered_json study = quiet_study();
  study["results"][0]["raw_times_s"] = {1.0, 1.3, 1.4};
  study["results"].push_back({{"method", "dblquad"}, {"case", "hard"}, {"setting", 1e-8}, {"raw_times_s", {9.0}}});
  study["results"].push_back({{"method", "dblquad"}, {"case", "worst"}, {"setting", 1e-8}, {"not_run", "no reason"}});
  study["context"]["machine"]["load"] = 0.7;
  study["context"]["compiler"]["build_type"] = "Debug";
  study["context"]["validation"] = true;
  add_warnings(study);
  const std::vector<std::string> expected = {
      "1 of 3 times lie over 20 % above their minimum: end other programs, run again or use time_min_s (gauss easy 16)",
      "1 slow settings were timed once, without a warm-up: read their times to one digit (dblquad hard 1e-08)",
      "busy machine (load 0.7 on 2 cores), methods on all cores lose most: end other programs, run again",
      "this is no Release build: configure with -DCMAKE_BUILD_TYPE=Release before using the times",
      "the Vulkan validation layer is on: unset DOLP_VALIDATION before using the times of vulkan-*"};
  EXPECT_EQ(study["warnings"].get<std::vector<std::string>>(), expected);
}

}  // namespace methods_test
