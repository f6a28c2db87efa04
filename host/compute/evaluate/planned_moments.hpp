#pragma once

#include <vector>

#include "model/evaluator.hpp"
#include "plan/moments_plan.hpp"

namespace dolp {

/// Computes the moments of the plan's request. The plan may interpolate the moments of a direction and an index. If an
/// input of the interpolation is infinite or NaN, the evaluator computes all these moments instead. `work` receives
/// counts and times. `progress` counts entries. Errors: the evaluator's, and Cancelled if `progress` returns false.
std::vector<Moments> planned_moments(const MomentsPlan& plan, ModelEvaluator& evaluator, const Progress& progress,
                                     Work& work);

}  // namespace dolp
