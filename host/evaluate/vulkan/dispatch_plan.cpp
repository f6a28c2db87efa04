#include "evaluate/vulkan/dispatch_plan.hpp"

#include <algorithm>

#include "evaluate/vulkan/kernels.hpp"
#include "evaluate/vulkan/tiles.hpp"

namespace dolp {

DispatchPlan dispatch_plan(const MomentsRequest& request, const DeviceDescription& device,
                           const VulkanOptions& options) {
  if (request.entries.empty()) return {};
  const vulkan::Packing packing(request.precision == Precision::kDouble);
  const KernelData data = kernel_data(request);
  const vulkan::TileCosts costs = vulkan::tile_costs(packing);
  const vulkan::TileSizes sizes =
      vulkan::tile_sizes({.buffer_bytes = device.max_storage_buffer_bytes,
                          .heap_bytes = device.heap_bytes,
                          .dispatch_count = std::uint64_t{device.max_workgroups} * vulkan::kLocalSize,
                          .tile_entries = std::min<std::uint64_t>(options.max_tile_entries, data.entries.size()),
                          .block_shapes = std::min<std::uint64_t>(options.max_block_shapes, data.shapes.size())},
                         costs);
  DispatchPlan plan{.tile_entries = sizes.entries, .block_shapes = sizes.shapes};
  for (const vulkan::Block& block : vulkan::blocks_of(data.entries, data.shapes.size(), sizes.shapes)) {
    plan.dispatches += (block.entries.size() + sizes.entries - 1) / sizes.entries;
    plan.dispatches += data.needs_masking_table() ? 1 : 0;
  }
  plan.device_bytes = sizes.entries * costs.entry_bytes + sizes.shapes * costs.shape_bytes +
                      data.rule_nodes.size() * packing.node_bytes<std::array<double, 4>>();
  return plan;
}

DeviceDescription least_device() {
  DeviceDescription least;
  least.max_storage_buffer_bytes = std::uint64_t{1} << 27U;
  least.max_workgroups = 65535;
  least.heap_bytes = std::uint64_t{1} << 30U;
  return least;
}

}  // namespace dolp
