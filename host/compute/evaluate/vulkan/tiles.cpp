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
          .shapes = at_least_one(
              std::min({bytes / costs.shape_bytes, limits.dispatch_count, limits.block_shapes,
                        costs.shape_texels > 0 ? limits.texels / costs.shape_texels : limits.block_shapes}))};
}

TileCosts tile_costs(const Packing& packing, const KernelData& data, std::uint32_t width) {
  using EntryWords = std::array<std::uint32_t, 4>;
  return {.invocation_bytes = sizeof(EntryWords) + packing.node_bytes<kernel::ThetaNode>() +
                              packing.node_bytes<kernel::IndexNode>() +
                              width * packing.output_bytes<kernel::MomentsNode>(column_sums(data)),
          .shape_bytes =
              packing.node_bytes<kernel::ShapeNode>() + packing.masking_nodes() * packing.node_bytes<MaskingNode>(),
          .shape_texels = packing.texels_of_table()};
}

TileCosts scattering_tile_costs(const Packing& packing) {
  return {.invocation_bytes = packing.node_bytes<kernel::BeamNode>() + packing.node_bytes<kernel::MuellerNode>(),
          .shape_bytes = 1};
}

std::uint32_t slope_tile_size(const TileLimits& limits, const Packing& packing, const KernelData& data) {
  const TileCosts costs{.invocation_bytes = packing.node_bytes<kernel::SlopeNode>() +
                                            packing.node_bytes<kernel::ThetaNode>() +
                                            packing.node_bytes<kernel::IndexNode>() +
                                            packing.output_bytes<kernel::AzimuthNode>(column_azimuths(data)),
                        .shape_bytes = 1};
  const std::uint32_t slopes = tile_sizes(limits, costs).invocations;
  return std::max(slopes - slopes % kLockstep, kLockstep);
}

std::uint64_t block_limit(const Rows& rows, std::uint64_t wanted) {
  return std::min<std::uint64_t>(std::max<std::uint64_t>(wanted, rows.width), rows.shapes.size());
}

std::vector<Block> blocks_of(const Rows& rows, std::uint32_t block_shapes) {
  std::vector<Block> blocks;
  std::uint32_t last_chunk = 0;
  for (std::uint32_t i = 0; i < rows.rows.size(); ++i) {
    const std::uint32_t number = rows.rows[i].chunk;
    const Chunk& chunk = rows.chunks[number];
    const bool is_new = blocks.empty() || number != last_chunk;
    const bool fits = !blocks.empty() && chunk.first + chunk.count - blocks.back().first_shape <= block_shapes;
    if (is_new && !fits) blocks.push_back({.first_shape = chunk.first, .first_row = i});
    Block& block = blocks.back();
    block.shape_count = chunk.first + chunk.count - block.first_shape;
    ++block.row_count;
    last_chunk = number;
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
