// One request for pBRDFs on the device, tile by tile.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "evaluate/vulkan/moments_run.hpp"
#include "plan/beam.hpp"

namespace dolp::vulkan {

KernelVariant mueller_variant(const ScatteringRequest& request);

/// Owns the buffers of one request and computes it. Entries bring their own shapes and need no tables, so that a tile's
/// size bounds the memory for any shapes.
class ScatteringRun {
 public:
  /// `tile_entries` bounds the size of a tile from above.
  ScatteringRun(const KernelContext& context, const ScatteringRequest& request, std::uint32_t tile_entries);

  /// All pBRDFs in the order of the request; nothing when `progress` returned false. Errors: DeviceError.
  std::optional<std::vector<ScatteringMatrix>> compute(const Progress& progress);
  const RunCost& cost() const { return cost_; }

 private:
  std::uint32_t tile_size(std::uint32_t tile_entries) const;
  void create_buffers();
  /// Records the upload; the first tile continues the recording.
  void upload_rule_nodes();
  void run_tile(std::span<const ScatteringEntry> entries, std::span<ScatteringMatrix> matrices);

  KernelContext context_;
  const ScatteringRequest& request_;
  BeamPlan plan_;
  std::uint32_t tile_size_;
  std::vector<Beam> beams_;
  std::vector<std::byte> scratch_;
  RunCost cost_;
  std::optional<InputBuffer> beam_buffer_, rule_node_buffer_;
  std::optional<Buffer> mueller_buffer_;
};

}  // namespace dolp::vulkan
