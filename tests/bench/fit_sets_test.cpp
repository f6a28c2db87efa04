// The sets of the study of fits whose valleys bend: intervals hold what the data do not exclude.
#include <gtest/gtest.h>

#include "evaluate/cpu/cpu_evaluator.hpp"
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

}  // namespace
