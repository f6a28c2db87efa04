#include <algorithm>
#include <chrono>

#include "base/parallel_ranges.hpp"
#include "base/stopwatch.hpp"
#include "evaluate/vulkan/tiled_run.hpp"
#include "evaluate/vulkan/tiles.hpp"

namespace dolp::vulkan {
namespace {

// A piece of a kernel row, which is an invocation of the kernel for rows, has at least as many slopes.
constexpr std::uint32_t kSlopesPerPiece = 16;

class SlopeRun final : public TiledRun {
 public:
  SlopeRun(const KernelContext& context, const MomentsRequest& request, const VulkanOptions& options)
      : TiledRun(context, options, request.precision),
        request_(request),
        tiles_(request, context.description, options),
        data_(tiles_.data),
        thetas_(data_.thetas.size()),
        indices_(request.optics.size()) {
    const std::size_t slopes = tiles_.slopes;
    pace_ = TilePace(options.tile_s, kSlopesPerPiece * options.first_tile_invocations, tiles_.slopes);
    add_tile_inputs<kernel::ThetaNode>(DOLP_BINDING_THETAS, std::min(slopes, data_.thetas.size()));
    add_tile_inputs<kernel::IndexNode>(DOLP_BINDING_INDICES, std::min(slopes, data_.indices.size()));
    add_tile_inputs<kernel::SlopeNode>(DOLP_BINDING_SLOPES, slopes);
    add_results(DOLP_BINDING_AZIMUTHS, result_bytes(slopes), data_, slopes_variant(data_));
  }

  std::vector<Moments> compute(const Progress& progress) override {
    std::vector<Moments> moments(request_.size());
    const std::size_t bundles = data_.bundles.size();
    cost_.curves_s = data_.curves_s;
    for (std::size_t first = 0; first < bundles; first += SlopeTiles::kBatchBundles) {
      const SlopeBatch batch = tiles_.batch(first);
      SampledAzimuths azimuths(batch.nodes, data_);
      const std::span<const std::uint32_t> slopes(batch.in_lockstep);
      for (std::size_t done = 0; done < slopes.size();) {
        begin_tile();
        if (cost_.dispatches == 0) upload_rule(data_);
        const auto tile = slopes.subspan(done, std::min<std::size_t>(pace_.invocations(), slopes.size() - done));
        done += tile.size();
        const double batch_share = static_cast<double>(done) / static_cast<double>(slopes.size());
        const double share = (static_cast<double>(first) + batch_share * static_cast<double>(batch.samples.size())) /
                             static_cast<double>(bundles);
        upload_tile(batch, tile);
        submit_tile(tile.size(), result_bytes(tile.size()), data_, [&, tile, share] {
          read_tile(batch, tile, azimuths);
          note_progress(progress, share, request_.size());
        });
      }
      finish_tiles();
      for (const kernel::AzimuthNode& azimuth : azimuths.nodes) cost_.evaluations += azimuth.evaluations;
      const auto start = std::chrono::steady_clock::now();
      parallel_for(batch.samples.size(), 1, [&](std::size_t i) {
        const SlopeSamples& samples = batch.samples[i];
        tiles_.sampling.integrate(samples, azimuths, batch.first_node[i], context_.unit_roundoff, moments);
      });
      cost_.sums_s += seconds_since(start);
    }
    return moments;
  }

 private:
  std::size_t result_bytes(std::size_t slopes) const {
    return orders_at_once(data_) * slopes * packing_.output_bytes<kernel::AzimuthNode>(column_azimuths(data_));
  }

  void upload_tile(const SlopeBatch& batch, std::span<const std::uint32_t> slopes) {
    thetas_.clear();
    indices_.clear();
    nodes_.clear();
    for (const std::uint32_t i : slopes) {
      kernel::SlopeNode& node = nodes_.emplace_back(batch.slopes[i]);
      node.theta = thetas_(static_cast<std::uint32_t>(node.theta));
      node.index = indices_(static_cast<std::uint32_t>(node.index));
    }
    const std::span<const std::uint32_t> thetas = thetas_.used(), indices = indices_.used();
    upload(DOLP_BINDING_SLOPES, nodes_.size(), [&](std::size_t i) { return nodes_[i]; });
    upload(DOLP_BINDING_THETAS, thetas.size(), [&](std::size_t i) { return data_.thetas[thetas[i]]; });
    upload(DOLP_BINDING_INDICES, indices.size(), [&](std::size_t i) { return data_.indices[indices[i]]; });
  }

  void read_tile(const SlopeBatch& batch, std::span<const std::uint32_t> slopes, SampledAzimuths& azimuths) {
    const std::size_t per_node = column_azimuths(data_);
    const std::size_t nodes = slopes.size() * batch.orders_at_once;
    const std::size_t behind = nodes * packing_.node_bytes<kernel::AzimuthNode>();
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      const SlopeBatch::Output& output = batch.outputs[slopes[i]];
      for (std::size_t g = 0; g < output.orders; ++g) {
        const std::size_t at = i * batch.orders_at_once + g;
        const std::size_t node = output.node + g * output.stride;
        azimuths.nodes[node] = packing_.read<kernel::AzimuthNode>(scratch_, at);
        packing_.read_numbers(scratch_, behind + at * per_node * packing_.real_bytes(), azimuths.slope_columns(node));
      }
    }
  }

  const MomentsRequest& request_;
  SlopeTiles tiles_;
  const KernelData& data_;
  Renumbering thetas_, indices_;
  std::vector<kernel::SlopeNode> nodes_;
};

}  // namespace

std::unique_ptr<TiledRun> slope_run(const KernelContext& context, const MomentsRequest& request,
                                    const VulkanOptions& options) {
  return std::make_unique<SlopeRun>(context, request, options);
}

}  // namespace dolp::vulkan
