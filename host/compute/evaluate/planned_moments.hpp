#pragma once

#include <vector>

#include "model/evaluator.hpp"
#include "plan/moments_plan.hpp"

namespace dolp {

/// Computes the moments of the plan's request. The plan may interpolate over the slope distributions. If a known
/// moment of a direction and index is infinite or NaN, the evaluator computes all moments of this pair. `work` gets
/// counts and times. `progress` counts entries. Errors: the evaluator's, and Cancelled if `progress` returns false.
std::vector<Moments> planned_moments(const MomentsPlan& plan, ModelEvaluator& evaluator, const Progress& progress,
                                     Work& work);

}  // namespace dolp
