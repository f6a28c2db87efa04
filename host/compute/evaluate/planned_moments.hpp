// Carries out the plan of a request for moments.
#pragma once

#include <vector>

#include "model/evaluator.hpp"
#include "plan/moments_plan.hpp"

namespace dolp {

/// The moments of the plan's request. A direction whose nodes have no finite bound is computed entry by entry.
/// Adds to `work` what the evaluator does not report: the entries that were interpolated or combined, the moments
/// computed for them, and the time that this took. Errors: those of the evaluator, which throws Cancelled when
/// `progress`, which counts entries, returns false.
std::vector<Moments> planned_moments(const MomentsPlan& plan, ModelEvaluator& evaluator, const Progress& progress,
                                     Work& work);

}  // namespace dolp
