// Fits of the bench study to synthetic data: chi^2 with several valleys, and a model without multiple bounces.
#include <gtest/gtest.h>

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "scene/scene_reader.hpp"
#include "studies/fit_sets.hpp"

namespace fit_sets_test {

using namespace dolp;
using namespace dolp::bench;

// chi^2 of these two data sets has several valleys. Intervals from only the lowest valley would exclude true values.
TEST(FitSets, BentValley_IntervalsHoldATruthThatTheDataDoNotExclude) {
  CpuEvaluator evaluator;
  for (const std::size_t number : {1005U, 1029U}) {
    const SetOutcome outcome = fit_outcome(fit_set(number), number, evaluator);
    EXPECT_TRUE(outcome.is_consistent()) << number;
    EXPECT_TRUE(outcome.is_global()) << number;
  }
}

// The data include multiple bounces. The model of the first fits has single scattering. These fits compare the data
// with the bracket, a range that contains Q/I with all bounces. Their intervals are wide and contain the true
// values. The model of the last fit has all bounces, and its interval is narrow.
TEST(FitSets, AllBounces_IntervalsOfTheBracketHoldTheTruth) {
  constexpr std::size_t kFewPoints = 6;  // points per data set; the study uses 15
  CpuEvaluator evaluator;
  FitSet set = bracket_set(1001);
  set.points = kFewPoints;
  const auto width_of_n = [&](const SetOutcome& outcome) {
    const FitInterval n = outcome.result.parameters.front().interval_95;
    return n.high.value_or(set.parameters.front().high) - n.low.value_or(set.parameters.front().low);
  };
  const SetOutcome with_bracket = fit_outcome(set, 1001, evaluator);
  EXPECT_EQ(with_bracket.held_95, 2U);
  EXPECT_EQ(with_bracket.held_68, 2U);
  set.scene = with_settings(set.scene, set.of_truth);
  set.model_error = ModelError::kNone;
  EXPECT_LT(width_of_n(fit_outcome(set, 1001, evaluator)), 0.25 * width_of_n(with_bracket));
}

}  // namespace fit_sets_test
