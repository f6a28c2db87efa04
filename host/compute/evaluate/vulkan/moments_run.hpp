// One request on the device, tile by tile.
#pragma once

#include <cstddef>
#include <dolp/errors.hpp>
#include <optional>
#include <span>
#include <vector>

#include "device/buffer.hpp"
#include "evaluate/vulkan/command_stream.hpp"
#include "evaluate/vulkan/input_buffer.hpp"
#include "evaluate/vulkan/kernels.hpp"
#include "evaluate/vulkan/packing.hpp"
#include "evaluate/vulkan/tiles.hpp"

namespace dolp::vulkan {

/// Objects that a run uses; they outlive the run.
struct KernelContext {
  const Device& device;
  Kernels& kernels;
  CommandStream& stream;
  Packing packing;
  bool staged_uploads = false;
  double tile_timeout_s = 0.0;
};

/// Cost of a run so far.
struct RunCost {
  std::uint64_t dispatches = 0;
  double evaluations = 0.0;
  double kernel_s = 0.0;
  double sums_s = 0.0;  ///< EvaluationReport::sums_s
};

/// Owns the buffers of one request and computes it.
class MomentsRun {
 public:
  /// `tile_invocations` and `block_shapes` bound the sizes of TileSizes from above.
  MomentsRun(const KernelContext& context, const MomentsRequest& request, std::uint32_t tile_invocations,
             std::uint32_t block_shapes);

  /// Creates the pipelines before the computation, so that their time is measured separately.
  void create_pipelines();

  /// The wanted moments at the places of their entries; nothing when `progress` returned false. Errors: DeviceError.
  std::optional<std::vector<Moments>> compute(const Progress& progress);
  const RunCost& cost() const { return cost_; }

 private:
  TileSizes sizes(std::uint32_t tile_invocations, std::uint32_t block_shapes) const;
  void create_buffers();
  /// Begins a submission with the inputs that all tiles of a block share; the first tile continues it.
  void begin_block(const Block& block);
  void upload_tile(const Block& block, std::span<const RowPiece> pieces);
  void run_tile(const Block& block, std::span<const RowPiece> pieces, std::span<kernel::MomentsNode> results);
  void add_pieces(std::span<const RowPiece> pieces, std::span<kernel::MomentsNode> results);
  std::vector<Moments> moments_of(std::span<const kernel::MomentsNode> results) const;
  template <class NodeOf>
  void upload(InputBuffer& buffer, std::size_t count, const NodeOf& node_of);

  KernelContext context_;
  const MomentsRequest& request_;
  KernelData data_;
  Rows rows_;
  TileSizes sizes_;
  Renumbering thetas_, indices_;
  std::vector<std::byte> scratch_;
  std::vector<double> column_results_;  ///< DOLP_COLUMN_PARTS sums for each column of each member
  RunCost cost_;
  std::optional<InputBuffer> theta_buffer_, shape_buffer_, index_buffer_, task_buffer_, rule_buffer_, rule_node_buffer_;
  std::optional<Buffer> masking_buffer_, moments_buffer_;
};

}  // namespace dolp::vulkan
