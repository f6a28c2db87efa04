#include <algorithm>
#include <future>

#include "base/parallel_ranges.hpp"
#include "evaluate/vulkan/tiled_run.hpp"
#include "evaluate/vulkan/tiles.hpp"

namespace dolp::vulkan {
namespace {

using TaskWords = std::array<std::uint32_t, 4>;

constexpr std::size_t kRowsAtOnce = 512;
constexpr std::size_t kEntriesAtOnce = 1024;
constexpr std::size_t kMostRanges = 16;  // ranges of rows in a tile, as each range looks at all pieces of the tile

class RowRun final : public TiledRun {
 public:
  RowRun(const KernelContext& context, const MomentsRequest& request, const VulkanOptions& options)
      : TiledRun(context, options, request.precision),
        request_(request),
        tiles_(request, context.description, options),
        data_(tiles_.data),
        rows_(tiles_.rows),
        thetas_(data_.thetas.size()),
        indices_(request.optics.size()),
        table_pace_(options.tile_s, options.first_tile_invocations, tiles_.sizes.shapes) {
    const std::size_t invocations = tiles_.sizes.invocations;
    const std::size_t shapes = tiles_.sizes.shapes;
    pace_ = TilePace(options.tile_s, options.first_tile_invocations, tiles_.sizes.invocations);
    add_tile_inputs<kernel::ThetaNode>(DOLP_BINDING_THETAS, std::min(invocations, data_.thetas.size()));
    add_shared_input(DOLP_BINDING_SHAPES, shapes * packing_.node_bytes<kernel::ShapeNode>());
    add_tile_inputs<kernel::IndexNode>(DOLP_BINDING_INDICES, std::min(invocations, data_.indices.size()));
    add_tile_input(DOLP_BINDING_TASKS, invocations * sizeof(TaskWords));
    add_masking_tables(data_.needs_masking_table() ? shapes : 1);
    add_results(DOLP_BINDING_MOMENTS, result_bytes(invocations), data_, moments_variant(data_, rows_.width));
  }

  void create_pipelines() override {
    const KernelVariant tables = masking_table_variant(data_);
    std::future<void> table_pipeline;
    if (data_.needs_masking_table() && !context_.kernels.has(tables)) {
      table_pipeline = std::async(std::launch::async, [&] { context_.kernels.pipeline(tables); });
    }
    TiledRun::create_pipelines();
    if (table_pipeline.valid()) table_pipeline.get();
  }

  std::vector<Moments> compute(const Progress& progress) override {
    cost_.curves_s = data_.curves_s;
    std::vector<kernel::MomentsNode> results(rows_.rows.size() * rows_.width);
    column_results_.assign(results.size() * column_sums(data_), 0.0);
    for (const Block& block : tiles_.blocks()) {
      const std::vector<RowPiece> pieces = row_pieces(rows_, data_, block.first_row, block.row_count);
      if (!pieces.empty()) begin_block(block);
      for (std::size_t first = 0; first < pieces.size();) {
        begin_tile();
        const std::size_t count = std::min<std::size_t>(pace_.invocations(), pieces.size() - first);
        const auto tile = std::span<const RowPiece>(pieces).subspan(first, count);
        first += count;
        const double block_share = static_cast<double>(first) / static_cast<double>(pieces.size());
        const double share = (block.first_row + block.row_count * block_share) / static_cast<double>(rows_.rows.size());
        upload_tile(block, tile);
        submit_tile(count, result_bytes(count), data_, [&, tile, share] {
          add_pieces(tile, results);
          note_progress(progress, share, request_.size());
        });
      }
      finish_tiles();
    }
    return entry_moments(results);
  }

 private:
  std::size_t result_bytes(std::size_t invocations) const {
    return invocations * rows_.width * packing_.output_bytes<kernel::MomentsNode>(column_sums(data_));
  }

  /// Uploads the shapes of a block and computes their masking tables, if the masking needs them.
  void begin_block(const Block& block) {
    CommandStream& stream = context_.stream;
    const std::uint32_t tables = data_.needs_masking_table() ? block.shape_count : 0;
    std::uint32_t first = 0;
    do {
      begin_tile();
      if (first == 0) {
        upload(DOLP_BINDING_SHAPES, block.shape_count,
               [&](std::size_t i) { return rows_.shapes[block.first_shape + i]; });
        if (cost_.dispatches == 0) upload_rule(data_);
      }
      stream.barrier(Barrier::kUploadToKernel);
      const std::uint32_t count = std::min(table_pace_.invocations(), tables - first);
      if (count > 0) {
        stream.dispatch(context_.kernels, context_.kernels.pipeline(masking_table_variant(data_)), first, count,
                        data_.rule_order);
        stream.barrier(Barrier::kKernelToKernel);
        ++cost_.dispatches;
      }
      submit({.pace = &table_pace_, .invocations = count});
      first += count;
    } while (first < tables);
  }

  void upload_tile(const Block& block, std::span<const RowPiece> pieces) {
    thetas_.clear();
    indices_.clear();
    std::vector<TaskWords> words;
    words.reserve(pieces.size());
    for (const RowPiece& row_piece : pieces) {
      const Row& row = rows_.rows[row_piece.row];
      const Chunk& chunk = rows_.chunks[row.chunk];
      const MomentsEntry entry = rows_.entry(data_, row);
      words.push_back({thetas_(entry.theta), chunk.first - block.first_shape, indices_(entry.index),
                       task_word(data_.pieces[entry.theta], row_piece.piece, chunk.count)});
    }
    upload_bytes(DOLP_BINDING_TASKS, std::as_bytes(std::span(words)));
    const std::span<const std::uint32_t> thetas = thetas_.used(), indices = indices_.used();
    upload(DOLP_BINDING_THETAS, thetas.size(), [&](std::size_t i) { return data_.thetas[thetas[i]]; });
    upload(DOLP_BINDING_INDICES, indices.size(), [&](std::size_t i) { return data_.indices[indices[i]]; });
  }

  void add_pieces(std::span<const RowPiece> pieces, std::span<kernel::MomentsNode> results) {
    const std::size_t members = pieces.size() * rows_.width;
    const std::size_t per_entry = column_sums(data_);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      cost_.evaluations += packing_.read<kernel::MomentsNode>(scratch_, i * rows_.width).evaluations;
    }
    // A thread sums all pieces of a row, in their order. So rounding does not depend on the number of threads.
    const auto [least, most] = std::ranges::minmax(pieces, {}, &RowPiece::row);
    const std::uint32_t first_row = least.row;
    const std::size_t rows = most.row - least.row + std::size_t{1};
    const std::size_t at_once = std::max(kRowsAtOnce, rows / kMostRanges);
    parallel_ranges(rows, at_once, [&](std::size_t first, std::size_t last) {
      std::vector<double> columns(per_entry);
      for (std::size_t i = 0; i < pieces.size(); ++i) {
        const std::size_t row = pieces[i].row - first_row;
        if (row < first || row >= last) continue;
        const std::uint32_t count = rows_.chunks[rows_.rows[pieces[i].row].chunk].count;
        for (std::uint32_t g = 0; g < count; ++g) {
          auto node = packing_.read<kernel::MomentsNode>(scratch_, i * rows_.width + g);
          node.evaluations /= count;
          const std::size_t member = pieces[i].row * std::size_t{rows_.width} + g;
          add_piece(results[member], node);
          packing_.read_numbers(scratch_,
                                members * packing_.node_bytes<kernel::MomentsNode>() +
                                    (i * rows_.width + g) * per_entry * packing_.real_bytes(),
                                columns);
          add_columns(data_, std::span<const double>(columns),
                      std::span(column_results_).subspan(member * per_entry, per_entry));
        }
      }
    });
  }

  std::vector<Moments> entry_moments(std::span<const kernel::MomentsNode> results) const {
    std::vector<Moments> moments(request_.size());
    const std::size_t per_entry = column_sums(data_);
    parallel_for(moments.size(), kEntriesAtOnce, [&](std::size_t i) {
      const auto& [row, place] = rows_.entries[i];
      const std::size_t at = row * std::size_t{rows_.width} + place;
      moments[i] =
          moments_from_kernel(results[at], data_, rows_.entry(data_, rows_.rows[row], place), context_.unit_roundoff,
                              std::span(column_results_).subspan(at * per_entry, per_entry));
    });
    return moments;
  }

  const MomentsRequest& request_;
  RowTiles tiles_;
  const KernelData& data_;
  const Rows& rows_;
  Renumbering thetas_, indices_;
  TilePace table_pace_;                 ///< for the masking tables
  std::vector<double> column_results_;  ///< DOLP_COLUMN_PARTS sums per column and entry (physics/columns.glsl)
};

}  // namespace

std::unique_ptr<TiledRun> row_run(const KernelContext& context, const MomentsRequest& request,
                                  const VulkanOptions& options) {
  return std::make_unique<RowRun>(context, request, options);
}

}  // namespace dolp::vulkan
