#include "plan/rows.hpp"
#include "plan/constants.hpp"

#include <algorithm>
#include <boost/functional/hash.hpp>
#include <numeric>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>

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

/// The chunks of the shapes of a bundle, as positions in `shapes`. They do not depend on the order of the shapes.
using BundleChunks = std::vector<std::vector<std::uint32_t>>;

BundleChunks bundle_chunks(const KernelData& data, std::span<const std::uint32_t> shapes, std::uint32_t width) {
  std::vector<std::uint32_t> ascending(shapes.size());
  std::iota(ascending.begin(), ascending.end(), 0U);
  const auto shape = [&](std::uint32_t i) { return data.slopes[shapes[i]]; };
  std::ranges::sort(ascending, {}, [&](std::uint32_t i) { return std::tuple(shape(i).sigma, shape(i).q, i); });
  BundleChunks chunks;
  for (const std::uint32_t i : ascending) {
    const bool is_next = !chunks.empty() && chunks.back().size() < width &&
                         shape(chunks.back().front()).sigma == shape(i).sigma &&
                         belongs(data, shapes[chunks.back().front()], shapes[i]);
    if (!is_next) chunks.emplace_back();
    chunks.back().push_back(i);
  }
  return chunks;
}

/// Orders the rows, so that neighbouring invocations of the kernel read the same data.
void order_rows(Rows& rows, const KernelData& data) {
  std::vector<std::uint32_t> order(rows.rows.size()), new_number(order.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, {}, [&](std::uint32_t i) {
    const Bundle& bundle = data.bundles[rows.rows[i].bundle];
    return std::tuple(rows.rows[i].chunk, bundle.index, bundle.direction, i);
  });
  std::vector<Row> ordered;
  for (const std::uint32_t i : order) {
    new_number[i] = static_cast<std::uint32_t>(ordered.size());
    ordered.push_back(rows.rows[i]);
  }
  rows.rows = std::move(ordered);
  for (RowEntry& entry : rows.entries) entry.row = new_number[entry.row];
}

Rows rows_of_width(const KernelData& data, std::uint32_t width) {
  Rows rows{.width = width};
  std::unordered_map<std::vector<std::uint32_t>, std::uint32_t, boost::hash<std::vector<std::uint32_t>>> known;
  const auto add_chunk = [&](const std::vector<std::uint32_t>& positions) {
    const auto [chunk, is_new] = known.try_emplace(positions, static_cast<std::uint32_t>(rows.chunks.size()));
    if (!is_new) return chunk->second;
    const std::size_t first = rows.shapes.size();
    rows.chunks.push_back({static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(positions.size())});
    rows.shape_positions.insert(rows.shape_positions.end(), positions.begin(), positions.end());
    for (const std::uint32_t shape : positions) rows.shapes.push_back(data.shapes[shape]);
    unite(std::span(rows.shapes).subspan(first));
    return chunk->second;
  };
  BundleChunks chunks;                 // those that the last bundle has
  std::vector<std::uint32_t> numbers;  // their positions in rows.chunks
  for (std::uint32_t number = 0; number < data.bundles.size(); ++number) {
    const Bundle& bundle = data.bundles[number];
    const std::span<const std::uint32_t> shapes = data.bundle_shapes(number);
    if (number == 0 || bundle.first != data.bundles[number - 1].first ||
        bundle.count != data.bundles[number - 1].count) {
      chunks = bundle_chunks(data, shapes, width);
      numbers.clear();
      for (std::vector<std::uint32_t> positions : chunks) {
        for (std::uint32_t& i : positions) i = shapes[i];
        numbers.push_back(add_chunk(positions));
      }
    }
    rows.entries.resize(bundle.first_entry + bundle.count);
    for (std::size_t i = 0; i < chunks.size(); ++i) {
      const auto row = static_cast<std::uint32_t>(rows.rows.size());
      rows.rows.push_back({number, numbers[i]});
      for (std::uint32_t place = 0; place < chunks[i].size(); ++place)
        rows.entries[bundle.first_entry + chunks[i][place]] = {row, place};
    }
  }
  order_rows(rows, data);
  return rows;
}

}  // namespace

Rows make_rows(const MomentsRequest& request, const KernelData& data, std::uint32_t widest) {
  std::vector<std::uint32_t> all(data.shapes.size());
  std::iota(all.begin(), all.end(), 0U);
  const double places = static_cast<double>(widest) * static_cast<double>(bundle_chunks(data, all, widest).size());
  const bool is_filled = !request.has_lone_entries && static_cast<double>(all.size()) > kLeastRowUse * places;
  return rows_of_width(data, is_filled ? widest : 1);
}

std::vector<RowPiece> row_pieces(const Rows& rows, const KernelData& data, std::uint32_t first, std::uint32_t count) {
  std::vector<std::uint32_t> counts;
  for (std::uint32_t i = first; i < first + count; ++i) {
    const Row& row = rows.rows[i];
    counts.push_back(piece_count(data, rows.entry(data, row).theta, rows.shapes[rows.chunks[row.chunk].first]));
  }
  std::vector<RowPiece> pieces;
  const std::uint32_t most = counts.empty() ? 0 : std::ranges::max(counts);
  for (std::uint32_t piece = 0; piece < most; ++piece) {
    for (std::uint32_t i = 0; i < count; ++i) {
      if (piece < counts[i]) pieces.push_back({first + i, piece});
    }
  }
  return pieces;
}

}  // namespace dolp
