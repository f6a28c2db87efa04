#include "methods/operations.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "evaluate/vulkan/kernels.hpp"

namespace dolp::bench {
namespace {

using Kind = std::uint64_t OperationCounts::*;

constexpr Kind kKinds[] = {&OperationCounts::add, &OperationCounts::multiply, &OperationCounts::divide,
                           &OperationCounts::square_root, &OperationCounts::other};

OperationCounts since(const OperationCounts& before) {
  OperationCounts counts = counted_operations();
  for (const Kind kind : kKinds) counts.*kind -= before.*kind;
  return counts;
}

void add_scaled(OperationCounts& sum, const OperationCounts& counts, double factor) {
  for (const Kind kind : kKinds) {
    sum.*kind += static_cast<std::uint64_t>(std::llround(factor * static_cast<double>(counts.*kind)));
  }
}

}  // namespace

KernelWork count_operations(const MomentsRequest& request, std::size_t workgroups, std::size_t lanes) {
  const GroupedWork work(request);
  const std::unique_ptr<GroupedKernel> kernel = make_counted_kernel(work);
  KernelWork result;
  const OperationCounts before_tables = counted_operations();
  for (std::size_t shape = 0; shape < work.rows.shapes.size(); ++shape) kernel->build_masking_table(shape);
  add_scaled(result.counts, since(before_tables), 1.0);
  const std::size_t all = (work.pieces.size() + vulkan::kLocalSize - 1) / vulkan::kLocalSize;
  const std::size_t count = std::min(workgroups, all);
  std::vector<kernel::MomentsNode> members(work.rows.width);
  const OperationCounts before = counted_operations();
  std::size_t pieces = 0;
  double evaluations = 0.0;
  double slowest = 0.0;  // sum over vectors: `lanes` times the operations of the slowest invocation
  double most = 0.0;
  for (std::size_t group = 0; group < count; ++group) {
    const std::size_t first = group * all / count * vulkan::kLocalSize;
    const std::size_t last = std::min(first + vulkan::kLocalSize, work.pieces.size());
    for (std::size_t piece = first; piece < last; ++piece) {
      const std::uint64_t flops = counted_operations().flops();
      kernel->run_pieces(piece, members);
      most = std::max(most, static_cast<double>(counted_operations().flops() - flops));
      evaluations += members.front().evaluations;
      ++pieces;
      const bool is_vector_done = (piece - first + 1) % lanes == 0 || piece + 1 == last;
      if (is_vector_done) slowest += static_cast<double>(lanes) * std::exchange(most, 0.0);
    }
  }
  const OperationCounts counted = since(before);
  const double factor = static_cast<double>(work.pieces.size()) / static_cast<double>(pieces);
  add_scaled(result.counts, counted, factor);
  result.evaluations = factor * evaluations;
  result.busy_lanes = static_cast<double>(counted.flops()) / slowest;
  return result;
}

}  // namespace dolp::bench
