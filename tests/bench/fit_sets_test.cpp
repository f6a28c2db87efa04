// The sets of the study of fits whose valleys bend: intervals hold what the data do not exclude.
#include <gtest/gtest.h>

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "scene/scene_reader.hpp"
#include "studies/fit_sets.hpp"

namespace {

using namespace dolp;
using namespace dolp::bench;

// A profile that follows the branch of the minimum alone leaves out a truth that lies on another one.
TEST(FitSets, BentValley_IntervalsHoldATruthThatTheDataDoNotExclude) {
  CpuEvaluator evaluator;
  for (const std::size_t number : {1005U, 1029U}) {
    const SetOutcome outcome = fit_outcome(fit_set(number), number, evaluator);
    EXPECT_TRUE(outcome.is_consistent()) << number;
    EXPECT_TRUE(outcome.is_global()) << number;
  }
}

// Single scattering with its bracket holds the truth of all bounces, and leaves much; the model of all bounces leaves
// little.
TEST(FitSets, AllBounces_IntervalsOfTheBracketHoldTheTruth) {
  constexpr std::size_t kFewPoints = 6;  // the study has 15
  CpuEvaluator evaluator;
  for (const std::size_t number : {1001U, 1002U, 1004U}) {
    FitSet set = bracket_set(number);
    set.points = kFewPoints;
    const SetOutcome outcome = fit_outcome(set, number, evaluator);
    EXPECT_EQ(outcome.held_95, 2U) << number;
    EXPECT_EQ(outcome.held_68, 2U) << number;
  }
  FitSet set = bracket_set(1001);
  set.points = kFewPoints;
  const auto width_of_n = [&] {
    const FitInterval n = fit_outcome(set, 1001, evaluator).result.parameters.front().interval_95;
    return n.high.value_or(set.parameters.front().high) - n.low.value_or(set.parameters.front().low);
  };
  const double bracket = width_of_n();
  set.scene = with_settings(set.scene, set.of_truth);
  set.model_error = ModelError::kNone;
  EXPECT_LT(width_of_n(), 0.25 * bracket);
}

}  // namespace
