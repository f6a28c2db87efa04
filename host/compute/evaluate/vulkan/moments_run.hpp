// One request on the device, tile by tile.
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
class MomentsRun : public TiledRun {
 public:
  MomentsRun(const KernelContext& context, const MomentsRequest& request, const VulkanOptions& options);

  /// Creates the pipelines before the computation, so that their time is measured separately.
  void create_pipelines();

  /// The wanted moments at the places of their entries; nothing when `progress` returned false. Errors: DeviceError.
  std::optional<std::vector<Moments>> compute(const Progress& progress);

 private:
  void create_buffers();
  /// Begins a submission with the inputs that all tiles of a block share; the first tile continues it.
  void begin_block(const Block& block);
  void upload_tile(const Block& block, std::span<const RowPiece> pieces);
  void run_tile(const Block& block, std::span<const RowPiece> pieces, std::span<kernel::MomentsNode> results);
  void add_pieces(std::span<const RowPiece> pieces, std::span<kernel::MomentsNode> results);
  std::vector<Moments> moments_of(std::span<const kernel::MomentsNode> results) const;

  const MomentsRequest& request_;
  RowTiles tiles_;
  const KernelData& data_;
  const Rows& rows_;
  Renumbering thetas_, indices_;
  std::vector<double> column_results_;  ///< DOLP_COLUMN_PARTS sums for each column of each member
  std::optional<InputBuffer> theta_buffer_, shape_buffer_, index_buffer_, task_buffer_;
  std::optional<Buffer> masking_buffer_, moments_buffer_;
};

}  // namespace dolp::vulkan
