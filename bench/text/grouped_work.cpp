#include "bench/text/grouped_text.hpp"

namespace dolp::bench {
namespace {

constexpr double kUnitRoundoff = 0x1p-24;  // of float

}  // namespace

GroupedWork::GroupedWork(const MomentsRequest& request)
    : data(kernel_data(request)),
      grouping(grouped(data, true)),  // as the evaluators are timed
      pieces(pieces_of(grouping, data, 0, static_cast<std::uint32_t>(grouping.groups.size()))) {}

std::vector<Moments> moments_of(const GroupedWork& work, const std::vector<kernel::MomentsNode>& nodes) {
  const std::size_t size = work.grouping.size;
  std::vector<kernel::MomentsNode> groups(work.grouping.groups.size() * size);
  for (std::size_t piece = 0; piece < work.pieces.size(); ++piece) {
    const std::size_t group = work.pieces[piece].group;
    for (std::size_t g = 0; g < size; ++g) {
      add_piece(groups[group * size + g], nodes[piece * size + g]);
    }
  }
  std::vector<Moments> moments;
  for (std::size_t i = 0; i < work.data.entries.size(); ++i) {
    const EntryPlace& place = work.grouping.places[i];
    moments.push_back(
        moments_from_kernel(groups[place.group * size + place.member], work.data, work.data.entries[i], kUnitRoundoff));
  }
  return moments;
}

}  // namespace dolp::bench
