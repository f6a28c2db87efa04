#include "evaluate/vulkan/dispatch_plan.hpp"

#include <algorithm>

#include "evaluate/vulkan/kernels.hpp"
#include "evaluate/vulkan/tiles.hpp"
#include "plan/beam.hpp"

namespace dolp {
namespace {

vulkan::TileLimits tile_limits(const DeviceDescription& device, std::uint64_t tile_entries,
                               std::uint64_t block_shapes) {
  return {.buffer_bytes = device.max_storage_buffer_bytes,
          .heap_bytes = device.heap_bytes,
          .dispatch_count = std::uint64_t{device.max_workgroups} * vulkan::kLocalSize,
          .tile_entries = tile_entries,
          .block_shapes = block_shapes};
}

std::uint64_t node_bytes(const vulkan::Packing& packing, const KernelData& data) {
  return data.rule_nodes.size() * packing.node_bytes<std::array<double, 4>>();
}

}  // namespace

DispatchPlan dispatch_plan(const MomentsRequest& request, const DeviceDescription& device,
                           const VulkanOptions& options) {
  if (request.entries.empty()) return {};
  const vulkan::Packing packing(request.precision == Precision::kDouble);
  const KernelData data = kernel_data(request);
  const vulkan::TileCosts costs = vulkan::tile_costs(packing);
  const vulkan::TileSizes sizes =
      vulkan::tile_sizes(tile_limits(device, std::min<std::uint64_t>(options.max_tile_entries, data.entries.size()),
                                     std::min<std::uint64_t>(options.max_block_shapes, data.shapes.size())),
                         costs);
  DispatchPlan plan{.tile_entries = sizes.entries, .block_shapes = sizes.shapes};
  for (const vulkan::Block& block : vulkan::blocks_of(data.entries, data.shapes.size(), sizes.shapes)) {
    plan.dispatches += (block.entries.size() + sizes.entries - 1) / sizes.entries;
    plan.dispatches += data.needs_masking_table() ? 1 : 0;
  }
  plan.device_bytes = sizes.entries * costs.entry_bytes + sizes.shapes * costs.shape_bytes + node_bytes(packing, data);
  return plan;
}

DispatchPlan dispatch_plan(const ScatteringRequest& request, const DeviceDescription& device,
                           const VulkanOptions& options) {
  if (request.entries.empty()) return {};
  const vulkan::Packing packing(request.precision == Precision::kDouble);
  const vulkan::TileCosts costs = vulkan::scattering_tile_costs(packing);
  const std::uint64_t wanted = std::min<std::uint64_t>(options.max_tile_entries, request.entries.size());
  const std::uint32_t entries = vulkan::tile_sizes(tile_limits(device, wanted, 1), costs).entries;
  return {.tile_entries = entries,
          .block_shapes = 0,
          .dispatches = (request.entries.size() + entries - 1) / entries,
          .device_bytes = entries * costs.entry_bytes + node_bytes(packing, BeamPlan(request).data())};
}

DeviceDescription least_device() {
  DeviceDescription least;
  least.max_storage_buffer_bytes = std::uint64_t{1} << 27U;
  least.max_workgroups = 65535;
  least.heap_bytes = std::uint64_t{1} << 30U;
  return least;
}

}  // namespace dolp
