#include "evaluate/vulkan/tiles.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <map>
#include <utility>

#include "base/parallel_ranges.hpp"
#include "evaluate/vulkan/command_stream.hpp"

namespace dolp::vulkan {
namespace {

using EntryWords = std::array<std::uint32_t, 4>;

constexpr std::uint64_t kHeapFraction =
    8;  // all tiles in flight get an eighth of the memory, masking tables another eighth

// Largest factor between the sizes of a tile and the next. Costs of neighbouring invocations can differ by a factor 10.
constexpr double kLargestChange = 4.0;

std::uint32_t at_least_one(std::uint64_t count) {
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(count, 1, UINT32_MAX));
}

TileSizes sizes_on(const dolp::Device& device, const TileCosts& costs, std::uint64_t invocations,
                   std::uint64_t shapes = 1) {
  // No single buffer exceeds its limit, because the limit holds even for the sum of all buffers of a tile.
  const std::uint64_t memory = device.memory_bytes / kHeapFraction;
  const std::uint64_t bytes = std::min(device.max_storage_buffer_bytes, memory);
  const std::uint64_t tile_bytes = std::min(device.max_storage_buffer_bytes, memory / kMostInFlight);
  const std::uint64_t dispatch_invocations = std::uint64_t{device.max_workgroups} * device.local_size;
  const std::uint64_t tables = costs.shape_texels > 0 ? device.max_texels / costs.shape_texels : shapes;
  return {
      .invocations = at_least_one(std::min({tile_bytes / costs.invocation_bytes, dispatch_invocations, invocations})),
      .shapes = at_least_one(std::min({bytes / costs.shape_bytes, dispatch_invocations, shapes, tables}))};
}

// Rule nodes that do not fit into the texels of a buffer are in a storage buffer, too.
std::uint64_t rule_bytes(const dolp::Device& device, const Packing& packing, const KernelData& data) {
  const std::uint64_t nodes = data.rule_nodes.size() + data.left_out_nodes;
  return (nodes + (nodes > device.max_texels ? device.max_texels : 0)) * packing.node_bytes<std::array<double, 2>>();
}

std::uint64_t tiles_in(std::uint64_t invocations, std::uint32_t tile) { return (invocations + tile - 1) / tile; }

// Orders the slopes in groups of kLockstep slopes with equal loop bounds. Repeats a slope where a group is incomplete.
std::vector<std::uint32_t> in_lockstep(const SlopeBatch& batch, const KernelData& data) {
  std::map<std::uint16_t, std::vector<std::uint32_t>> by_bound;
  for (std::size_t i = 0; i < batch.samples.size(); ++i) {
    const SlopeSamples& samples = batch.samples[i];
    const MomentsEntry entry = data.entry(samples.bundle, data.bundle_shapes(samples.bundle).front());
    const Pieces& pieces = data.pieces[entry.theta];
    for (const SampledPiece& piece : samples.pieces) {
      std::vector<std::uint32_t>& alike = by_bound[pieces.lockstep[piece.direction_piece]];
      for (std::size_t order = 0; order < samples.orders; order += batch.orders_at_once) {
        const std::size_t first = batch.first[i] + order / batch.orders_at_once * samples.slopes.size() + piece.first;
        for (std::size_t k = 0; k < piece.fine + piece.coarse; ++k) {
          alike.push_back(static_cast<std::uint32_t>(first + k));
        }
      }
    }
  }
  std::vector<std::uint32_t> order;
  for (const auto& [bound, alike] : by_bound) {
    order.insert(order.end(), alike.begin(), alike.end());
    while (order.size() % kLockstep != 0) order.push_back(alike.back());
  }
  return order;
}

Packing make_packing(Precision precision) { return Packing(precision == Precision::kDouble); }

// An invocation that computes several entries evaluates the reflectances once for all, but has more values at a time.
// A GPU has registers for too few of them, and would keep the rest in memory (bench/README.md, "Kernels on GPUs").
std::uint32_t widest_row(const dolp::Device& device) { return device.type == dolp::Device::Type::kCpu ? kRowWidth : 1; }

}  // namespace

void TilePace::note(std::size_t invocations, double seconds) {
  if (2 * invocations < invocations_) return;  // the rest of some work, too small to occupy the device
  const double size = invocations_;
  const double wanted = tile_s_ / seconds * static_cast<double>(invocations);
  const auto next = static_cast<std::uint32_t>(std::clamp(wanted, size / kLargestChange, size * kLargestChange));
  // Whole lockstep groups take the shortest time.
  invocations_ = std::clamp(next - next % kLockstep, std::min(kLockstep, most_), most_);
}

RowTiles::RowTiles(const MomentsRequest& request, const dolp::Device& device, const VulkanOptions& options,
                   Tables tables)
    : packing(make_packing(request.precision)),
      data(kernel_data(request, tables)),
      rows(make_rows(request, data, widest_row(device))),
      costs{.invocation_bytes = sizeof(EntryWords) + packing.node_bytes<kernel::ThetaNode>() +
                                packing.node_bytes<kernel::IndexNode>() +
                                rows.width * packing.output_bytes<kernel::MomentsNode>(column_sums(data)),
            .shape_bytes =
                packing.node_bytes<kernel::ShapeNode>() + packing.masking_nodes() * packing.node_bytes<MaskingNode>(),
            .shape_texels = packing.texels_of_table(),
            .rule_bytes = rule_bytes(device, packing, data)} {
  const std::uint64_t pieces = rows.rows.size() * DOLP_MAX_PIECES;
  // At least rows.width shapes, because a kernel row needs the masking tables of all its shapes.
  const std::uint64_t shapes =
      std::min<std::uint64_t>(std::max(options.max_block_shapes, rows.width), rows.shapes.size());
  sizes = sizes_on(device, costs, std::min<std::uint64_t>(options.max_tile_invocations, pieces), shapes);
}

std::vector<Block> RowTiles::blocks() const {
  std::vector<Block> blocks;
  std::uint32_t last_chunk = 0;
  for (std::uint32_t i = 0; i < rows.rows.size(); ++i) {
    const std::uint32_t number = rows.rows[i].chunk;
    const Chunk& chunk = rows.chunks[number];
    const bool is_new = blocks.empty() || number != last_chunk;
    const bool fits = !blocks.empty() && chunk.first + chunk.count - blocks.back().first_shape <= sizes.shapes;
    if (is_new && !fits) blocks.push_back({.first_shape = chunk.first, .first_row = i});
    Block& block = blocks.back();
    block.shape_count = chunk.first + chunk.count - block.first_shape;
    ++block.row_count;
    last_chunk = number;
  }
  return blocks;
}

DispatchCount RowTiles::count() const {
  DispatchCount count{.tile_invocations = sizes.invocations, .block_shapes = sizes.shapes, .row_width = rows.width};
  count.rows = rows.rows.size();
  for (const Block& block : blocks()) {
    count.dispatches += tiles_in(row_pieces(rows, data, block.first_row, block.row_count).size(), sizes.invocations);
    if (data.needs_masking_table()) ++count.dispatches;
  }
  count.device_bytes =
      kMostInFlight * sizes.invocations * costs.invocation_bytes + sizes.shapes * costs.shape_bytes + costs.rule_bytes;
  return count;
}

SlopeTiles::SlopeTiles(const MomentsRequest& request, const dolp::Device& device, const VulkanOptions& options,
                       Tables tables)
    : packing(make_packing(request.precision)),
      data(kernel_data(request, tables)),
      sampling(data),
      costs{.invocation_bytes = packing.node_bytes<kernel::SlopeNode>() + packing.node_bytes<kernel::ThetaNode>() +
                                packing.node_bytes<kernel::IndexNode>() +
                                orders_at_once(data) * packing.output_bytes<kernel::AzimuthNode>(column_azimuths(data)),
            .rule_bytes = rule_bytes(device, packing, data)} {
  const std::uint64_t most = data.bundles.size() * DOLP_MAX_PIECES * 2 * static_cast<std::uint64_t>(data.rule_order);
  const std::uint32_t fit =
      sizes_on(device, costs, std::min<std::uint64_t>(options.max_tile_invocations, most)).invocations;
  slopes = std::max(fit - fit % kLockstep, kLockstep);
}

SlopeBatch SlopeTiles::batch(std::size_t first) const {
  SlopeBatch batch;
  batch.samples.resize(std::min(kBatchBundles, data.bundles.size() - first));
  parallel_for(batch.samples.size(), 1, [&](std::size_t i) { batch.samples[i] = sampling.plan(first + i); });
  batch.orders_at_once = orders_at_once(data);
  for (const SlopeSamples& samples : batch.samples) {
    batch.first.push_back(batch.slopes.size());
    batch.first_node.push_back(batch.nodes);
    sampling.append(samples, batch.orders_at_once, batch.slopes);
    const std::size_t stride = samples.slopes.size();
    for (std::size_t order = 0; order < samples.orders; order += batch.orders_at_once) {
      const std::size_t count = std::min(batch.orders_at_once, samples.orders - order);
      for (std::size_t i = 0; i < stride; ++i)
        batch.outputs.push_back({batch.nodes + order * stride + i, stride, count});
    }
    batch.nodes += samples.nodes();
  }
  batch.in_lockstep = in_lockstep(batch, data);
  return batch;
}

std::size_t orders_at_once(const KernelData& data) { return data.orders.highest > 0 ? DOLP_ROW_WIDTH : 1; }

DispatchCount SlopeTiles::count() const {
  DispatchCount count{.tile_invocations = slopes};
  for (std::size_t first = 0; first < data.bundles.size(); first += kBatchBundles) {
    const SlopeBatch slope_batch = batch(first);
    count.dispatches += tiles_in(slope_batch.in_lockstep.size(), slopes);
    count.rows += slope_batch.samples.size();
    count.slopes += slope_batch.slopes.size();
  }
  count.device_bytes = kMostInFlight * slopes * costs.invocation_bytes + costs.rule_bytes;
  return count;
}

std::uint32_t Renumbering::operator()(std::uint32_t member) {
  std::uint32_t& number = number_[member];
  if (number == kUnused) {
    number = static_cast<std::uint32_t>(used_.size());
    used_.push_back(member);
  }
  return number;
}

void Renumbering::clear() {
  for (const std::uint32_t member : used_) number_[member] = kUnused;
  used_.clear();
}

}  // namespace dolp::vulkan

namespace dolp {

vulkan::DispatchCount count_dispatches(const MomentsRequest& request, const dolp::Device& device) {
  if (request.size() == 0) return {};
  const VulkanOptions options;
  if (has_slope_samples(request)) return vulkan::SlopeTiles(request, device, options, Tables::kCounted).count();
  return vulkan::RowTiles(request, device, options, Tables::kCounted).count();
}

dolp::Device least_device() {
  dolp::Device least;
  least.max_storage_buffer_bytes = std::uint64_t{1} << 27U;
  least.max_texels = 65536;
  least.max_workgroups = 65535;
  least.memory_bytes = std::uint64_t{1} << 30U;
  return least;
}

}  // namespace dolp
