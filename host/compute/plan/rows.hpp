// Entries of a bundle that differ only in the exponent q share nodes, facets and reflection, so one invocation of the
// kernel computes them together (Row of shaders/physics/row.glsl).
#pragma once

#include <cstdint>
#include <vector>

#include "model/moments.hpp"
#include "plan/kernel_data.hpp"

namespace dolp {

/// Largest number of entries in a kernel row. Kernels exist for rows of one entry and for rows of this many entries.
inline constexpr std::uint32_t kRowWidth = DOLP_ROW_WIDTH;

/// Shapes that share the Gauss nodes of a kernel row: equal sigma, ascending q.
struct Chunk {
  std::uint32_t first = 0;  ///< position in Rows::shapes
  std::uint32_t count = 1;  ///< at most the width of a row
};

struct Row {
  std::uint32_t bundle = 0;
  std::uint32_t chunk = 0;
};

/// Where the results of an entry are: in one of Rows::rows, at one of its places.
struct RowEntry {
  std::uint32_t row = 0;
  std::uint32_t place = 0;
};

struct RowPiece {
  std::uint32_t row = 0;
  std::uint32_t piece = 0;  ///< position among the smooth pieces into which the slope axis is split
};

struct Rows {
  std::uint32_t width = 1;                ///< 1 or kRowWidth
  std::vector<kernel::ShapeNode> shapes;  ///< chunk by chunk; a chunk has one scale, cut, table_scale and cusp_digits
  std::vector<std::uint32_t> shape_positions;  ///< position of each of `shapes` in KernelData::shapes
  std::vector<Chunk> chunks;
  std::vector<Row> rows;          ///< ordered by chunk, index and direction
  std::vector<RowEntry> entries;  ///< one for each entry of the kernel data

  /// The member `place` of a row.
  MomentsEntry entry(const KernelData& data, const Row& row, std::uint32_t place = 0) const {
    return data.entry(row.bundle, shape_positions[chunks[row.chunk].first + place]);
  }
};

/// Kernel rows with `widest` places for entries, kRowWidth or 1. If at least half of the places would be empty in rows
/// with all shapes of the request, the rows have one place. Which entries of a bundle share a row does not depend on
/// other bundles.
Rows make_rows(const MomentsRequest& request, const KernelData& data, std::uint32_t widest);

/// The pieces of `count` rows from row `first`. Each invocation of the kernel computes one piece. Pieces with about
/// equal work are neighbours, because neighbouring invocations wait for each other.
std::vector<RowPiece> row_pieces(const Rows& rows, const KernelData& data, std::uint32_t first, std::uint32_t count);

}  // namespace dolp
