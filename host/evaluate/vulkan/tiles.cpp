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
  return {.entries = at_least_one(std::min({bytes / costs.entry_bytes, limits.dispatch_count, limits.tile_entries})),
          .shapes = at_least_one(std::min({bytes / costs.shape_bytes, limits.dispatch_count, limits.block_shapes}))};
}

TileCosts tile_costs(const Packing& packing) {
  using EntryWords = std::array<std::uint32_t, 4>;
  using MaskingNode = std::array<double, 4>;
  return {.entry_bytes = sizeof(EntryWords) + packing.node_bytes<kernel::ThetaNode>() +
                         packing.node_bytes<kernel::IndexNode>() + packing.node_bytes<kernel::MomentsNode>(),
          .shape_bytes =
              packing.node_bytes<kernel::ShapeNode>() + packing.masking_nodes() * packing.node_bytes<MaskingNode>()};
}

TileCosts scattering_tile_costs(const Packing& packing) {
  return {.entry_bytes = packing.node_bytes<kernel::BeamNode>() + packing.node_bytes<kernel::MuellerNode>(),
          .shape_bytes = 1};
}

std::vector<Block> blocks_of(std::span<const MomentsEntry> entries, std::size_t shape_count,
                             std::uint32_t block_shapes) {
  assert(block_shapes > 0);
  std::vector<Block> blocks((shape_count + block_shapes - 1) / block_shapes);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const std::size_t first = i * block_shapes;
    blocks[i].first_shape = static_cast<std::uint32_t>(first);
    blocks[i].shape_count = static_cast<std::uint32_t>(std::min<std::size_t>(block_shapes, shape_count - first));
  }
  for (std::size_t i = 0; i < entries.size(); ++i) blocks[entries[i].shape / block_shapes].entries.push_back(i);
  std::erase_if(blocks, [](const Block& block) { return block.entries.empty(); });
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
