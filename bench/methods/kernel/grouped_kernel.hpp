// The kernel source as C++ in float, in the rows and pieces in which a Vulkan device gets it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "plan/kernel_data.hpp"
#include "plan/rows.hpp"

namespace dolp::bench {

/// A request as the kernel gets it.
struct GroupedWork {
  explicit GroupedWork(const MomentsRequest& request);

  KernelData data;
  Rows rows;
  std::vector<RowPiece> pieces;  ///< the invocations, in the order of the device
};

/// The kernels of shaders/ over one piece of work, which must outlive the object. All members may be called from
/// several threads at a time, for different shapes and pieces.
class GroupedKernel {
 public:
  virtual ~GroupedKernel() = default;

  /// Fills the masking table of a shape of the rows; needed before the pieces where the data needs tables.
  virtual void build_masking_table(std::size_t shape) = 0;

  /// Runs invocations first, first + 1, ..., which give a node for each member of their row, until `members` is full.
  virtual void run_pieces(std::size_t first, std::span<kernel::MomentsNode> members) = 0;
};

/// Adds what the pieces gave, row by row, and turns it into moments in the order of the request.
std::vector<Moments> moments_of(const GroupedWork& work, const std::vector<kernel::MomentsNode>& nodes);

/// True where the builds below can do this work: they support the cauchy distribution without total reflection, and the
/// maskings that the device computes by rows.
inline bool has_kernel_for(const KernelData& data) {
  return data.distribution == Distribution::kCauchy && !data.has_total_reflection && data.needs_masking_table();
}

/// Compiled for this processor, one invocation after the other, vectors where the compiler finds some.
std::unique_ptr<GroupedKernel> make_native_kernel(const GroupedWork& work);

/// Operations of arithmetic, by kind.
struct OperationCounts {
  std::uint64_t add = 0;  ///< and subtractions
  std::uint64_t multiply = 0;
  std::uint64_t divide = 0;
  std::uint64_t square_root = 0;
  std::uint64_t other = 0;  ///< comparisons, minima, maxima, sign, floor, powers of two, conversions

  /// Floating-point operations, one each; `other` are none.
  std::uint64_t flops() const { return add + multiply + divide + square_root; }
};

/// Counts what it does; one thread at a time.
std::unique_ptr<GroupedKernel> make_counted_kernel(const GroupedWork& work);

/// The operations that this thread has counted since the program began.
OperationCounts counted_operations();

}  // namespace dolp::bench
