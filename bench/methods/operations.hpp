// Count of the arithmetic operations of the moments kernel for a request.
#pragma once

#include <cstddef>

#include "methods/kernel/grouped_kernel.hpp"

namespace dolp::bench {

/// Arithmetic operations of the float kernels for one request. Kernels that make the masking tables are included.
struct KernelWork {
  OperationCounts counts;  ///< operations for all entries, extrapolated from the counted invocations
  double evaluations = 0.0;
  /// Upper bound of the share of vector lanes that are busy, one invocation per lane. A finished invocation waits for
  /// the slowest invocation in its vector. On a device invocations also wait within loops, so the share is smaller.
  double busy_lanes = 1.0;
};

/// Counts the operations in an evenly spread sample of workgroups, and extrapolates to the whole request. Accuracy: a
/// few percent, if the sample is typical. `workgroups`: size of the sample. `lanes`: size of a vector. Domain: requests
/// that has_kernel_for accepts.
KernelWork count_operations(const MomentsRequest& request, std::size_t workgroups, std::size_t lanes);

}  // namespace dolp::bench
