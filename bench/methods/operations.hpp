// Count of the arithmetic operations of the moments kernel for a request.
#pragma once

#include <cstddef>

#include "methods/kernel/grouped_kernel.hpp"

namespace dolp::bench {

/// Operations of the float kernels for one request, masking tables included.
struct KernelWork {
  OperationCounts counts;  ///< of all entries, extrapolated from the invocations that were counted
  double evaluations = 0.0;
  /// Share of the operations that are useful where `lanes` neighbouring invocations run in lockstep and wait for the
  /// one with the most work: an upper bound, for they also wait within loops.
  double busy_lanes = 1.0;
};

/// Runs `workgroups` workgroups of the kernel, evenly spread, in arithmetic that counts.
/// Accuracy: a few percent, for the rest is like the sample. Domain: has_kernel_for.
KernelWork count_operations(const MomentsRequest& request, std::size_t workgroups, std::size_t lanes);

}  // namespace dolp::bench
