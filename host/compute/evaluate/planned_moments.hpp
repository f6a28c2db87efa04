#pragma once

#include <vector>

#include "model/evaluator.hpp"
#include "plan/moments_plan.hpp"

namespace dolp {

/// Computes the moments of the plan's request. If a moment to interpolate from is infinite or NaN, all entries of its
/// direction and index are computed instead. `work` receives counts and times. `progress` counts entries.
/// Errors: the evaluator's errors, and Cancelled if `progress` returns false.
std::vector<Moments> planned_moments(const MomentsPlan& plan, ModelEvaluator& evaluator, const Progress& progress,
                                     Work& work);

}  // namespace dolp
