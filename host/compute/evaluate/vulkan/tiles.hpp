// Division of a request into tiles and blocks for the device. Pure: no Vulkan.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "evaluate/vulkan/packing.hpp"
#include "plan/rows.hpp"

namespace dolp::vulkan {

/// A node of a masking table, in double.
using MaskingNode = std::array<double, 4>;

/// Limits set by the device and the options.
struct TileLimits {
  std::uint64_t buffer_bytes = 0;      ///< of one storage buffer
  std::uint64_t heap_bytes = 0;        ///< of the device's memory
  std::uint64_t dispatch_count = 0;    ///< invocations of one dispatch
  std::uint64_t tile_invocations = 0;  ///< wanted at most
  std::uint64_t block_shapes = 0;      ///< wanted at most
  std::uint64_t texels = 0;            ///< of a texel buffer
};

/// Bytes that an invocation (a piece of a row, or a beam) and a shape take in the buffers.
struct TileCosts {
  std::uint64_t invocation_bytes = 0;  ///< all buffers that grow with the invocations of a tile
  std::uint64_t shape_bytes = 0;       ///< the masking table and the node of a shape
  std::uint64_t shape_texels = 0;      ///< the masking table
};

/// Invocations of a dispatch and shapes bound at a time, at least one each.
struct TileSizes {
  std::uint32_t invocations = 1;
  std::uint32_t shapes = 1;
};

/// The largest sizes within the limits; tiles and masking tables take at most an eighth of the heap each.
TileSizes tile_sizes(const TileLimits& limits, const TileCosts& costs);

/// Bytes of a piece of a row, and of a shape, of the moments in a precision.
TileCosts tile_costs(const Packing& packing, const KernelData& data, std::uint32_t width);

/// The same costs for pBRDFs, whose entries bring their own shapes.
TileCosts scattering_tile_costs(const Packing& packing);

/// Invocations that may run in lockstep on a device that bounds their loops, so that each waits for the longest: the
/// numbers of lavapipe's widest vector.
inline constexpr std::uint32_t kLockstep = 16;

/// Slope samples in a dispatch: a multiple of kLockstep, so that none of its groups is cut.
std::uint32_t slope_tile_size(const TileLimits& limits, const Packing& packing, const KernelData& data);

/// Chunks of shapes whose masking tables are bound together, and the rows that need them.
struct Block {
  std::uint32_t first_shape = 0;
  std::uint32_t shape_count = 0;
  std::uint32_t first_row = 0;
  std::uint32_t row_count = 0;
};

/// The limit of a block's shapes, which holds any chunk.
std::uint64_t block_limit(const Rows& rows, std::uint64_t wanted);

/// Cuts the shapes between chunks into blocks of at most `block_shapes`, which hold any chunk.
std::vector<Block> blocks_of(const Rows& rows, std::uint32_t block_shapes);

/// Numbers the members of a list in the order of their first use: a tile binds only what its rows use.
class Renumbering {
 public:
  explicit Renumbering(std::size_t list_size) : number_(list_size, kUnused) {}
  /// The number of a member of the list.
  std::uint32_t operator()(std::uint32_t member);
  /// Members in the order of their numbers.
  std::span<const std::uint32_t> used() const { return used_; }
  void clear();

 private:
  static constexpr std::uint32_t kUnused = UINT32_MAX;
  std::vector<std::uint32_t> number_, used_;
};

}  // namespace dolp::vulkan
