// One request for pBRDFs on the device, tile by tile.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "evaluate/vulkan/tiled_run.hpp"
#include "evaluate/vulkan/tiles.hpp"

namespace dolp::vulkan {

KernelVariant mueller_variant(const ScatteringRequest& request);

/// Owns the buffers of one request and computes it. Entries bring their own shapes and need no tables, so that a tile's
/// size bounds the memory for any shapes.
class ScatteringRun : public TiledRun {
 public:
  ScatteringRun(const KernelContext& context, const ScatteringRequest& request, const VulkanOptions& options);

  /// All pBRDFs in the order of the request; nothing when `progress` returned false. Errors: DeviceError.
  std::optional<std::vector<ScatteringMatrix>> compute(const Progress& progress);

 private:
  void create_buffers();
  void run_tile(std::span<const ScatteringEntry> entries, std::span<ScatteringMatrix> matrices);

  const ScatteringRequest& request_;
  BeamTiles tiles_;
  std::vector<Beam> beams_;
  std::optional<InputBuffer> beam_buffer_;
  std::optional<Buffer> mueller_buffer_;
};

}  // namespace dolp::vulkan
