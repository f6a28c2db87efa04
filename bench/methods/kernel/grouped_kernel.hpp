// The kernel source of shaders/, compiled as C++ in float. As on a Vulkan device, each invocation computes one piece of
// the integral over slopes, for one kernel row. A kernel row is a group of entries that differ only in q.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "plan/kernel_data.hpp"
#include "plan/rows.hpp"

namespace dolp::bench {

/// The inputs of the kernel for a request.
struct GroupedWork {
  explicit GroupedWork(const MomentsRequest& request);

  KernelData data;
  Rows rows;
  std::vector<RowPiece> pieces;  ///< kernel row and piece of the integral of each invocation, in the device's order
};

/// The kernels of shaders/ for one GroupedWork, which must outlive this object. Several threads may call the functions
/// at the same time if no two of them write the same masking table or the same results.
class GroupedKernel {
 public:
  virtual ~GroupedKernel() = default;

  /// Fills the masking table of one shape. Call this for every shape before run_pieces.
  virtual void build_masking_table(std::size_t shape) = 0;

  /// Runs invocation `first` and its successors until `members` is full. Each invocation writes Rows::width results,
  /// one for each entry of its kernel row. If the row has fewer entries, the other results are unused.
  virtual void run_pieces(std::size_t first, std::span<kernel::MomentsNode> members) = 0;
};

/// Sums the results of all pieces for each entry. `nodes` are the results of all invocations. Returns the moments in
/// the order of the request.
std::vector<Moments> moments_of(const GroupedWork& work, const std::vector<kernel::MomentsNode>& nodes);

/// True if make_native_kernel and make_counted_kernel support these data: the Cauchy distribution, no total reflection,
/// and `integral` or `smith` masking.
inline bool has_kernel_for(const KernelData& data) {
  return data.distribution == Distribution::kCauchy && !data.has_total_reflection && data.needs_masking_table();
}

/// A kernel that is compiled for this processor. It runs one invocation after another. The compiler uses vector
/// instructions where it can.
std::unique_ptr<GroupedKernel> make_native_kernel(const GroupedWork& work);

/// Arithmetic operations by kind.
struct OperationCounts {
  std::uint64_t add = 0;  ///< additions and subtractions
  std::uint64_t multiply = 0;
  std::uint64_t divide = 0;
  std::uint64_t square_root = 0;
  std::uint64_t other = 0;  ///< comparisons, minima, maxima, sign, floor, powers of two, conversions

  /// Number of floating-point operations, without `other`.
  std::uint64_t flops() const { return add + multiply + divide + square_root; }
};

/// A kernel that counts the operations of the calling thread. Only one thread at a time may call it.
std::unique_ptr<GroupedKernel> make_counted_kernel(const GroupedWork& work);

/// The operations that this thread has counted since the program began.
OperationCounts counted_operations();

}  // namespace dolp::bench
