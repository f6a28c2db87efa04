#include "evaluate/vulkan/tiles.hpp"

#include <algorithm>
#include <array>
#include <cassert>

namespace dolp::vulkan {
namespace {

constexpr std::uint64_t kHeapFraction = 8;

std::uint32_t at_least_one(std::uint64_t count) {
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(count, 1, UINT32_MAX));
}

}  // namespace

TileSizes tile_sizes(const TileLimits& limits, const TileCosts& costs) {
  // Both costs are sums over buffers, so they bound each of the buffers.
  const std::uint64_t bytes = std::min(limits.buffer_bytes, limits.heap_bytes / kHeapFraction);
  return {.invocations =
              at_least_one(std::min({bytes / costs.invocation_bytes, limits.dispatch_count, limits.tile_invocations})),
          .shapes = at_least_one(std::min({bytes / costs.shape_bytes, limits.dispatch_count, limits.block_shapes}))};
}

TileCosts tile_costs(const Packing& packing, std::uint32_t group_size) {
  using EntryWords = std::array<std::uint32_t, 4>;
  using MaskingNode = std::array<double, 4>;
  return {.invocation_bytes = sizeof(EntryWords) + packing.node_bytes<kernel::ThetaNode>() +
                              packing.node_bytes<kernel::IndexNode>() +
                              group_size * packing.node_bytes<kernel::MomentsNode>(),
          .shape_bytes =
              packing.node_bytes<kernel::ShapeNode>() + packing.masking_nodes() * packing.node_bytes<MaskingNode>()};
}

TileCosts scattering_tile_costs(const Packing& packing) {
  return {.invocation_bytes = packing.node_bytes<kernel::BeamNode>() + packing.node_bytes<kernel::MuellerNode>(),
          .shape_bytes = 1};
}

std::vector<Block> blocks_of(const Grouping& grouping, std::uint32_t block_shapes) {
  std::vector<Block> blocks;
  std::uint32_t family = 0, group = 0;
  while (group < grouping.groups.size()) {
    family = grouping.groups[group].family;
    Block block{.first_shape = grouping.families[family].first, .first_group = group};
    while (family < grouping.families.size()) {
      const std::uint32_t with_it = block.shape_count + grouping.families[family].count;
      if (block.shape_count > 0 && with_it > block_shapes) break;
      block.shape_count = with_it;
      ++family;
    }
    while (group < grouping.groups.size() && grouping.groups[group].family < family) ++group;
    block.group_count = group - block.first_group;
    blocks.push_back(block);
  }
  return blocks;
}

std::uint32_t Renumbering::operator()(std::uint32_t member) {
  std::uint32_t& number = number_[member];
  if (number == kUnused) {
    number = static_cast<std::uint32_t>(used_.size());
    used_.push_back(member);
  }
  return number;
}

void Renumbering::clear() {
  for (const std::uint32_t member : used_) number_[member] = kUnused;
  used_.clear();
}

}  // namespace dolp::vulkan
