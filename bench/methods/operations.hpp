// Count of the arithmetic operations of the moments kernel for a request.
#pragma once

#include <cstddef>

#include "methods/kernel/grouped_kernel.hpp"

namespace dolp::bench {

/// Operations of the float kernels for one request, masking tables included.
struct KernelWork {
  OperationCounts counts;  ///< operations for all entries, extrapolated from the counted invocations
  double evaluations = 0.0;
  /// Useful share of the operations if `lanes` neighbouring invocations run in lockstep and wait for the slowest. An
  /// upper bound, because lanes also wait within loops.
  double busy_lanes = 1.0;
};

/// Runs `workgroups` evenly spread workgroups of the kernel with counting arithmetic.
/// Accuracy: a few percent, if the other workgroups resemble these. Domain: has_kernel_for.
KernelWork count_operations(const MomentsRequest& request, std::size_t workgroups, std::size_t lanes);

}  // namespace dolp::bench
