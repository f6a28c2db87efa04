#include "plan/rows.hpp"
#include "plan/constants.hpp"

#include <algorithm>
#include <numeric>
#include <span>

namespace dolp {
namespace {

// At smaller m, a kernel row has one shape, because masking tables of heavy and light tails need different scales.
constexpr double kSmallestSharedM = 1e-3;

bool belongs(const KernelData& data, std::uint32_t first, std::uint32_t next) {
  const kernel::ShapeNode& a = data.shapes[first];
  return data.distribution == Distribution::kCauchy && a.m >= kSmallestSharedM &&
         data.shapes[next].q_minus_1 <= kMostRowSpread * a.q_minus_1 && data.needs_line[first] == data.needs_line[next];
}

// The kernel reads some members only from a chunk's first shape, so all shapes get the most demanding values.
void unite(std::span<kernel::ShapeNode> chunk) {
  kernel::ShapeNode common = chunk.front();
  for (const kernel::ShapeNode& shape : chunk) {
    common.scale = std::min(common.scale, shape.scale);
    common.cut = std::max(common.cut, shape.cut);
    common.table_scale = std::min(common.table_scale, shape.table_scale);
    common.cusp_digits = std::max(common.cusp_digits, shape.cusp_digits);
  }
  for (kernel::ShapeNode& shape : chunk) {
    shape.scale = common.scale;
    shape.cut = common.cut;
    shape.table_scale = common.table_scale;
    shape.cusp_digits = common.cusp_digits;
  }
}

void add_chunk(Rows& rows, const KernelData& data, std::span<const std::uint32_t> shapes) {
  const auto first = static_cast<std::uint32_t>(rows.shapes.size());
  rows.chunks.push_back({first, static_cast<std::uint32_t>(shapes.size())});
  for (const std::uint32_t shape : shapes) {
    rows.shape_positions.push_back(shape);
    rows.shapes.push_back(data.shapes[shape]);
  }
  unite(std::span(rows.shapes).subspan(first));
}

void add_grid_chunks(Rows& rows, const MomentsRequest& request, const KernelData& data) {
  std::vector<std::uint32_t> ascending(request.q.size());
  std::iota(ascending.begin(), ascending.end(), 0U);
  std::ranges::stable_sort(ascending, {}, [&](std::uint32_t i) { return request.q[i]; });
  const auto q_count = static_cast<std::uint32_t>(request.q.size());
  std::vector<std::uint32_t> chunk;
  for (std::uint32_t sigma = 0; sigma < request.sigma.size(); ++sigma) {
    const auto close = [&] {
      if (!chunk.empty()) add_chunk(rows, data, chunk);
      chunk.clear();
    };
    for (const std::uint32_t q : ascending) {
      const std::uint32_t shape = sigma * q_count + q;
      if (!chunk.empty() && (chunk.size() == rows.width || !belongs(data, chunk.front(), shape))) close();
      chunk.push_back(shape);
    }
    close();
  }
}

std::uint32_t used_members(const Rows& rows, const MomentsRequest& request, const KernelData& data, const Row& row) {
  const Chunk& chunk = rows.chunks[row.chunk];
  if (request.wanted.empty()) return chunk.count;
  std::uint32_t used = 0;
  for (std::uint32_t member = chunk.first; member < chunk.first + chunk.count; ++member) {
    used += request.is_wanted(data.entry_position(row.direction, row.index, rows.shape_positions[member])) ? 1 : 0;
  }
  return used;
}

Rows grid_chunks(const MomentsRequest& request, const KernelData& data, std::uint32_t widest) {
  Rows rows;
  rows.width = widest;
  add_grid_chunks(rows, request, data);
  if (static_cast<double>(data.shapes.size()) > kLeastRowUse * static_cast<double>(widest * rows.chunks.size()))
    return rows;
  rows = {};
  add_grid_chunks(rows, request, data);
  return rows;
}

void add_grid_rows(Rows& rows, const MomentsRequest& request, const KernelData& data) {
  if (request.wanted.empty()) rows.rows.reserve(rows.chunks.size() * data.indices.size() * data.directions);
  for (std::uint32_t chunk = 0; chunk < rows.chunks.size(); ++chunk) {
    for (std::uint32_t index = 0; index < data.indices.size(); ++index) {
      for (std::uint32_t direction = 0; direction < data.directions; ++direction) {
        Row row{direction, index, chunk};
        row.used = used_members(rows, request, data, row);
        if (row.used > 0) rows.rows.push_back(row);
      }
    }
  }
}

Rows point_rows(const KernelData& data) {
  Rows rows;
  for (std::uint32_t shape = 0; shape < data.shapes.size(); ++shape) add_chunk(rows, data, {&shape, 1});
  for (std::uint32_t point = 0; point < data.directions; ++point) {
    rows.rows.push_back({point, point, data.shape_positions[point]});
  }
  return rows;
}

}  // namespace

Rows make_rows(const MomentsRequest& request, const KernelData& data, std::uint32_t widest) {
  if (!data.is_grid) return point_rows(data);
  Rows rows = grid_chunks(request, data, widest);
  add_grid_rows(rows, request, data);
  return rows;
}

std::vector<RowPiece> row_pieces(const Rows& rows, const KernelData& data, std::uint32_t first, std::uint32_t count) {
  const auto same_work = [&](const Row& a, const Row& b) {
    return !data.is_grid || (a.chunk == b.chunk && a.index == b.index);
  };
  std::vector<RowPiece> pieces;
  std::vector<std::uint32_t> counts;
  const std::uint32_t end = first + count;
  for (std::uint32_t begin = first; begin < end;) {
    std::uint32_t next = begin + 1;
    while (next < end && same_work(rows.rows[begin], rows.rows[next])) ++next;
    counts.clear();
    for (std::uint32_t i = begin; i < next; ++i) {
      const Row& row = rows.rows[i];
      counts.push_back(piece_count(data, rows.theta_position(data, row), rows.shapes[rows.chunks[row.chunk].first]));
    }
    for (std::uint32_t piece = 0; piece < std::ranges::max(counts); ++piece) {
      for (std::uint32_t i = begin; i < next; ++i) {
        if (piece < counts[i - begin]) pieces.push_back({i, piece});
      }
    }
    begin = next;
  }
  return pieces;
}

}  // namespace dolp
