// Several descents in parallel, so that the model is computed for all of them in one batch.
#pragma once

#include <cstddef>
#include <functional>

#include "fit/residuals.hpp"

namespace dolp::fit {

/// Calls task(own, i) for i = 0, ..., count - 1, each in a thread of its own, at most 64 at once. `own` is a copy of
/// `residuals`; what all tasks ask of their copies goes to the evaluator together, as soon as every task that still
/// runs waits for an answer. Batches, hence results, do not depend on the threads' timing. Errors: those of the
/// evaluator and of the tasks, the first in their order.
void run_together(Residuals& residuals, std::size_t count,
                  const std::function<void(Residuals& own, std::size_t i)>& task);

}  // namespace dolp::fit
