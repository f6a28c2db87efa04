#include "evaluate/vulkan/dispatch_forecast.hpp"

#include <algorithm>

#include "evaluate/vulkan/kernels.hpp"
#include "evaluate/vulkan/slope_run.hpp"
#include "evaluate/vulkan/tiles.hpp"
#include "plan/beam.hpp"
#include "plan/rows.hpp"

namespace dolp {
namespace {

vulkan::TileLimits tile_limits(const dolp::Device& device, std::uint64_t tile_invocations, std::uint64_t block_shapes) {
  return {.buffer_bytes = device.max_storage_buffer_bytes,
          .heap_bytes = device.memory_bytes,
          .dispatch_count = std::uint64_t{device.max_workgroups} * device.local_size,
          .tile_invocations = tile_invocations,
          .block_shapes = block_shapes,
          .texels = device.max_texels};
}

std::uint64_t node_bytes(const vulkan::Packing& packing, const KernelData& data) {
  return data.rule_nodes.size() * packing.node_bytes<std::array<double, 2>>();
}

DispatchForecast slope_forecast(const MomentsRequest& request, const vulkan::Packing& packing,
                                const dolp::Device& device, const VulkanOptions& options) {
  const KernelData data = kernel_data(request);
  const SlopeSampling sampling(data);
  const std::size_t at_once = vulkan::batch_directions(data);
  const std::uint32_t slopes =
      vulkan::slope_tile_size(tile_limits(device, options.max_tile_invocations, 1), packing, data);
  DispatchForecast forecast{.tile_invocations = slopes};
  for (std::size_t first = 0; first < data.directions; first += at_once) {
    const vulkan::SlopeBatch batch =
        vulkan::slope_batch(request, data, sampling, first, std::min(first + at_once, data.directions));
    forecast.dispatches += (batch.in_lockstep.size() + slopes - 1) / slopes;
    forecast.rows += batch.samples.size();
    forecast.slopes += batch.slopes.size();
  }
  forecast.device_bytes = slopes * (packing.node_bytes<kernel::SlopeNode>() +
                                    packing.output_bytes<kernel::AzimuthNode>(column_azimuths(data)) +
                                    packing.node_bytes<kernel::ThetaNode>() + packing.node_bytes<kernel::IndexNode>()) +
                          node_bytes(packing, data);
  return forecast;
}

}  // namespace

DispatchForecast dispatch_forecast(const MomentsRequest& request, const dolp::Device& device,
                                   const VulkanOptions& given) {
  if (request.wanted_count() == 0) return {};
  const VulkanOptions options = for_device(given, device, request.precision);
  const vulkan::Packing packing(request.precision == Precision::kDouble);
  if (has_slope_samples(request)) return slope_forecast(request, packing, device, options);
  const KernelData data = kernel_data(request);
  const Rows rows = rows_of(request, data);
  const vulkan::TileCosts costs = vulkan::tile_costs(packing, data, rows.width);
  const std::uint64_t most = rows.rows.size() * DOLP_MAX_PIECES;
  const vulkan::TileSizes sizes =
      vulkan::tile_sizes(tile_limits(device, std::min<std::uint64_t>(options.max_tile_invocations, most),
                                     vulkan::block_limit(rows, options.max_block_shapes)),
                         costs);
  DispatchForecast forecast{.tile_invocations = sizes.invocations, .block_shapes = sizes.shapes};
  forecast.row_width = rows.width;
  forecast.rows = rows.rows.size();
  for (const vulkan::Block& block : vulkan::blocks_of(rows, sizes.shapes)) {
    const std::size_t pieces = pieces_of(rows, data, block.first_row, block.row_count).size();
    forecast.dispatches += (pieces + sizes.invocations - 1) / sizes.invocations;
    if (data.needs_masking_table()) ++forecast.dispatches;
  }
  forecast.device_bytes =
      sizes.invocations * costs.invocation_bytes + sizes.shapes * costs.shape_bytes + node_bytes(packing, data);
  return forecast;
}

DispatchForecast dispatch_forecast(const ScatteringRequest& request, const dolp::Device& device,
                                   const VulkanOptions& given) {
  if (request.entries.empty()) return {};
  const VulkanOptions options = for_device(given, device, request.precision);
  const vulkan::Packing packing(request.precision == Precision::kDouble);
  const vulkan::TileCosts costs = vulkan::scattering_tile_costs(packing);
  const std::uint64_t wanted = std::min<std::uint64_t>(options.max_tile_invocations, request.entries.size());
  const std::uint32_t beams = vulkan::tile_sizes(tile_limits(device, wanted, 1), costs).invocations;
  return {.tile_invocations = beams,
          .block_shapes = 0,
          .dispatches = (request.entries.size() + beams - 1) / beams,
          .device_bytes = beams * costs.invocation_bytes + node_bytes(packing, BeamPlan(request).data())};
}

dolp::Device least_device() {
  dolp::Device least;
  least.max_storage_buffer_bytes = std::uint64_t{1} << 27U;
  least.max_texels = 65536;
  least.max_workgroups = 65535;
  least.memory_bytes = std::uint64_t{1} << 30U;
  return least;
}

}  // namespace dolp
