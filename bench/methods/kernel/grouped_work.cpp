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
      node.evaluations /= rows.chunks[rows.rows[row].chunk].count;
      add_piece(sums[row * rows.width + g], node);
    }
  }
  std::vector<Moments> moments(rows.entries.size());
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const auto& [row, place] = rows.entries[i];
    moments[i] = moments_from_kernel(sums[row * rows.width + place], work.data,
                                     rows.entry(work.data, rows.rows[row], place), kUnitRoundoff);
  }
  return moments;
}

}  // namespace dolp::bench
