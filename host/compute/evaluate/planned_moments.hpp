#pragma once

#include <vector>

#include "model/evaluator.hpp"
#include "plan/moments_plan.hpp"

namespace dolp {

/// Computes the moments of the request of `plan`. If the moments at the interpolation nodes of a direction are not
/// finite, the entries of this direction are computed one by one. Adds to `work` how many entries were interpolated or
/// combined from responses, how many moments were computed for them, and the time. `progress` counts entries.
/// Errors: the evaluator's errors, and Cancelled if `progress` returns false.
std::vector<Moments> planned_moments(const MomentsPlan& plan, ModelEvaluator& evaluator, const Progress& progress,
                                     Work& work);

}  // namespace dolp
