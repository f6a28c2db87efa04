// Groups the entries that one invocation of the kernel computes together: entries of a grid that differ only in the
// exponent q share the nodes, the facets and their reflection (Row of shaders/physics/row.glsl).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/moments.hpp"
#include "plan/kernel_data.hpp"

namespace dolp {

/// Row widths for which the kernel is compiled.
inline constexpr std::array<std::uint32_t, 4> kRowWidths = {1, 4, 8, 16};

/// Consecutive shapes of one sigma, in ascending order of q, that share the nodes; or the shape of points.
struct Chunk {
  std::uint32_t first = 0;  ///< position in Rows::shapes
  std::uint32_t count = 1;  ///< at most the width of a row
};

/// A direction, an index and a chunk.
struct Row {
  std::uint32_t direction = 0;  ///< of the request
  std::uint32_t index = 0;
  std::uint32_t chunk = 0;
  std::uint32_t used = 1;  ///< members that are wanted
};

/// One invocation of the kernel.
struct RowPiece {
  std::uint32_t row = 0;
  std::uint32_t piece = 0;  ///< of the slope axis
};

/// The rows of a request that have a wanted entry.
struct Rows {
  std::uint32_t width = 1;                ///< most members of a row
  std::vector<kernel::ShapeNode> shapes;  ///< ordered by chunk; scale, cut and cusp are those of the chunk
  std::vector<std::uint32_t> shape_of;    ///< of each of `shapes` its position in the data
  std::vector<Chunk> chunks;
  std::vector<Row> rows;  ///< ordered by chunk, index and direction

  /// The direction of a row, as a position in the data's.
  std::uint32_t theta_of(const KernelData& data, const Row& row) const {
    return data.theta_of(row.direction, row.index, shape_of[chunks[row.chunk].first]);
  }
};

/// Rows of the request's width; for width 0, the width with the least work, compilation of the kernel included. The
/// neighbours of an entry follow from the shapes and the run's size, not from directions, indices and wanted entries.
Rows rows_of(const MomentsRequest& request, const KernelData& data);
/// Rows of another width.
Rows rows_of(const MomentsRequest& request, const KernelData& data, std::uint32_t width);

/// The invocations of rows first, first + 1, ...: neighbours differ only in the direction, so that their work is equal.
std::vector<RowPiece> pieces_of(const Rows& rows, const KernelData& data, std::uint32_t first, std::uint32_t count);

}  // namespace dolp
