// One request on the device by slope samples, which serve all slope distributions: some directions at a time.
#pragma once

#include <cstddef>
#include <dolp/errors.hpp>
#include <optional>
#include <span>
#include <vector>

#include "evaluate/kernel/slope_samples.hpp"
#include "evaluate/vulkan/moments_run.hpp"

namespace dolp::vulkan {

/// Slope samples that are planned, sampled and integrated together, with the kernel's input for them.
struct SlopeBatch {
  std::vector<SlopeSamples> samples;
  std::vector<std::size_t> first;          ///< first slope of each
  std::vector<kernel::SlopeNode> slopes;   ///< of all samples
  std::vector<std::uint32_t> in_lockstep;  ///< the order for the device, with gaps filled: positions of slopes
};

/// The batch of directions first ... last - 1 of a request.
SlopeBatch slope_batch(const MomentsRequest& request, const KernelData& data, const SlopeSampling& sampling,
                       std::size_t first, std::size_t last);

/// Number of directions in a batch that keeps the memory of its azimuths small.
std::size_t batch_directions(const KernelData& data);

/// Owns the buffers of one request and computes it.
class SlopeRun {
 public:
  /// `tile_slopes` bounds the invocations of a dispatch from above.
  SlopeRun(const KernelContext& context, const MomentsRequest& request, std::uint32_t tile_slopes);

  /// Creates the pipeline before the computation, so that its time is measured separately.
  void create_pipelines() { context_.kernels.pipeline(slopes_variant(data_)); }

  /// The wanted moments at the places of their entries; nothing when `progress` returned false. Errors: DeviceError.
  std::optional<std::vector<Moments>> compute(const Progress& progress);
  const RunCost& cost() const { return cost_; }

 private:
  std::uint32_t tile_size(std::uint32_t tile_slopes) const;
  void create_buffers();
  template <class NodeOf>
  void upload(InputBuffer& buffer, std::size_t count, const NodeOf& node_of);
  /// Records the upload; the first tile continues the recording.
  void upload_rule();
  void run_tile(const SlopeBatch& batch, std::span<const std::uint32_t> slopes, SampledAzimuths& azimuths);

  KernelContext context_;
  const MomentsRequest& request_;
  KernelData data_;
  SlopeSampling sampling_;
  std::uint32_t tile_size_;
  Renumbering thetas_, indices_;
  std::vector<kernel::SlopeNode> nodes_;  ///< of a tile
  std::vector<std::byte> scratch_;
  RunCost cost_;
  std::optional<InputBuffer> theta_buffer_, index_buffer_, slope_buffer_, rule_buffer_, rule_node_buffer_;
  std::optional<Buffer> azimuth_buffer_;
};

}  // namespace dolp::vulkan
