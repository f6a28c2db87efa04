// Count of the arithmetic operations of the moments kernel for a request.
#pragma once

#include <cstddef>

#include "methods/kernel/grouped_kernel.hpp"

namespace dolp::bench {

/// Operations of the float kernels for one request, including those that make the masking tables.
struct KernelWork {
  OperationCounts counts;  ///< operations for all entries, extrapolated from the counted invocations
  double evaluations = 0.0;
  /// Largest possible share of the lanes of a device that compute. `lanes` neighbouring invocations run together. The
  /// count assumes that each waits for the slowest only at its end. On a device, invocations also wait within loops.
  double busy_lanes = 1.0;
};

/// Counts the operations of `workgroups` evenly spread workgroups, and extrapolates to the whole request. Accuracy: a
/// few percent, if the other workgroups resemble the counted ones. Domain: requests that has_kernel_for accepts.
KernelWork count_operations(const MomentsRequest& request, std::size_t workgroups, std::size_t lanes);

}  // namespace dolp::bench
