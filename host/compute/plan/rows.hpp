// Which entries one invocation of the kernel computes together: those of a grid that differ in the exponent q alone
// share the nodes, the facets and their reflection (Row of shaders/physics/row.glsl).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/moments.hpp"
#include "plan/kernel_data.hpp"

namespace dolp {

/// Members of a row that the kernel is compiled for.
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

/// The rows of a request, without those of which nothing is wanted.
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

/// Rows of the request's width; of 0, that which takes the least work, of which making the kernel is a part. The
/// neighbours of an entry follow from the shapes and the run's size, not from directions, indices and what is wanted.
Rows rows_of(const MomentsRequest& request, const KernelData& data);
/// Rows of another width.
Rows rows_of(const MomentsRequest& request, const KernelData& data, std::uint32_t width);

/// The invocations of rows first, first + 1, ...: neighbours differ in the direction, so that they do the same work.
std::vector<RowPiece> pieces_of(const Rows& rows, const KernelData& data, std::uint32_t first, std::uint32_t count);

}  // namespace dolp
