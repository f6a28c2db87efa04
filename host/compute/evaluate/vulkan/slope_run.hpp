// One request on the device by slope samples, which serve all slope distributions: some directions at a time.
#pragma once

#include <cstddef>
#include <dolp/errors.hpp>
#include <optional>
#include <span>
#include <vector>

#include "evaluate/vulkan/tiled_run.hpp"
#include "evaluate/vulkan/tiles.hpp"

namespace dolp::vulkan {

/// Owns the buffers of one request and computes it.
class SlopeRun : public TiledRun {
 public:
  SlopeRun(const KernelContext& context, const MomentsRequest& request, const VulkanOptions& options);

  /// Creates the pipeline before the computation, so that its time is measured separately.
  void create_pipelines() { context_.kernels.pipeline(slopes_variant(data_)); }

  /// The wanted moments at the places of their entries; nothing when `progress` returned false. Errors: DeviceError.
  std::optional<std::vector<Moments>> compute(const Progress& progress);

 private:
  void create_buffers();
  void run_tile(const SlopeBatch& batch, std::span<const std::uint32_t> slopes, SampledAzimuths& azimuths);

  const MomentsRequest& request_;
  SlopeTiles tiles_;
  const KernelData& data_;
  Renumbering thetas_, indices_;
  std::vector<kernel::SlopeNode> nodes_;  ///< of a tile
  std::optional<InputBuffer> theta_buffer_, index_buffer_, slope_buffer_;
  std::optional<Buffer> azimuth_buffer_;
};

}  // namespace dolp::vulkan
