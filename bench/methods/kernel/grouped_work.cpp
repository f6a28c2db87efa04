#include "methods/kernel/grouped_kernel.hpp"

namespace dolp::bench {
namespace {

constexpr double kUnitRoundoff = 0x1p-24;  // relative rounding error of float

}  // namespace

GroupedWork::GroupedWork(const MomentsRequest& request)
    : data(kernel_data(request)),
      rows(make_rows(request, data, kRowWidth)),
      pieces(row_pieces(rows, data, 0, static_cast<std::uint32_t>(rows.rows.size()))) {}

std::vector<Moments> moments_of(const GroupedWork& work, const std::vector<kernel::MomentsNode>& nodes) {
  const Rows& rows = work.rows;
  std::vector<kernel::MomentsNode> sums(rows.rows.size() * rows.width);
  for (std::size_t i = 0; i < work.pieces.size(); ++i) {
    const std::size_t row = work.pieces[i].row;
    for (std::size_t g = 0; g < rows.width; ++g) {
      kernel::MomentsNode node = nodes[i * rows.width + g];
      node.evaluations /= rows.rows[row].used;
      add_piece(sums[row * rows.width + g], node);
    }
  }
  std::vector<Moments> moments(work.data.size());
  for (std::size_t i = 0; i < rows.rows.size(); ++i) {
    const Row& row = rows.rows[i];
    const Chunk& chunk = rows.chunks[row.chunk];
    const std::uint32_t theta = rows.theta_position(work.data, row);
    for (std::uint32_t g = 0; g < chunk.count; ++g) {
      const std::uint32_t shape = rows.shape_positions[chunk.first + g];
      moments[work.data.entry_position(row.direction, row.index, shape)] =
          moments_from_kernel(sums[i * rows.width + g], work.data, {theta, shape, row.index}, kUnitRoundoff);
    }
  }
  return moments;
}

}  // namespace dolp::bench
