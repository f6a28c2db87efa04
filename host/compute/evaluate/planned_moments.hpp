// Carries out the plan of a request for moments.
#pragma once

#include <vector>

#include "model/evaluator.hpp"
#include "plan/moments_plan.hpp"

namespace dolp {

/// Computes the moments of the plan's request. A direction whose nodes have no finite bound is computed entry by entry.
/// Adds the work of the host to `work`: entries that were interpolated or combined, moments computed for them, and
/// time. `progress` counts entries. Errors: the evaluator's errors, and Cancelled if `progress` returns false.
std::vector<Moments> planned_moments(const MomentsPlan& plan, ModelEvaluator& evaluator, const Progress& progress,
                                     Work& work);

}  // namespace dolp
