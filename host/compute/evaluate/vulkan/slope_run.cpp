#include "evaluate/vulkan/slope_run.hpp"

#include <algorithm>
#include <chrono>
#include <map>

#include "base/parallel_ranges.hpp"
#include "base/stopwatch.hpp"

namespace dolp::vulkan {
namespace {

// Bounds the memory of a batch: some hundred slopes each.
constexpr std::size_t kSampledAtOnce = 1024;

// The slopes in the order for the device: slopes that run in lockstep have the same loop bounds. Copies of the slope
// before a gap fill the gap.
std::vector<std::uint32_t> in_lockstep(const SlopeBatch& batch, const KernelData& data) {
  std::map<std::uint16_t, std::vector<std::uint32_t>> by_bound;
  for (std::size_t i = 0; i < batch.samples.size(); ++i) {
    const SlopeSamples& samples = batch.samples[i];
    const Pieces& pieces = data.pieces[samples.entries.theta];
    for (const SampledPiece& piece : samples.pieces) {
      std::vector<std::uint32_t>& alike = by_bound[pieces.lockstep[piece.of_direction]];
      for (std::uint32_t k = piece.first; k < piece.first + piece.fine + piece.coarse; ++k) {
        alike.push_back(static_cast<std::uint32_t>(batch.first[i] + k));
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

}  // namespace

std::size_t batch_directions(const KernelData& data) {
  return std::max<std::size_t>(kSampledAtOnce / (data.is_grid ? data.indices.size() : 1), 1);
}

SlopeBatch slope_batch(const MomentsRequest& request, const KernelData& data, const SlopeSampling& sampling,
                       std::size_t first, std::size_t last) {
  std::vector<SampledEntries> entries = sampled_entries(request, data, first, last);
  SlopeBatch batch;
  batch.samples.resize(entries.size());
  parallel_ranges(entries.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) batch.samples[i] = sampling.plan(std::move(entries[i]));
  });
  for (const SlopeSamples& samples : batch.samples) {
    batch.first.push_back(batch.slopes.size());
    sampling.append(samples, batch.slopes);
  }
  batch.in_lockstep = in_lockstep(batch, data);
  return batch;
}

SlopeRun::SlopeRun(const KernelContext& context, const MomentsRequest& request, std::uint32_t tile_slopes)
    : context_(context),
      request_(request),
      data_(kernel_data(request)),
      sampling_(data_),
      tile_size_(tile_size(tile_slopes)),
      thetas_(data_.thetas.size()),
      indices_(request.indices.size()) {
  create_buffers();
}

std::uint32_t SlopeRun::tile_size(std::uint32_t tile_slopes) const {
  const VkPhysicalDeviceLimits& limits = context_.device.limits();
  const std::uint64_t pairs = std::uint64_t{data_.directions} * (data_.is_grid ? data_.indices.size() : 1);
  const std::uint64_t most = pairs * DOLP_MAX_PIECES * 2 * static_cast<std::uint64_t>(data_.rule_order);
  return slope_tile_size(
      {.buffer_bytes = limits.maxStorageBufferRange,
       .heap_bytes = context_.device.heap_bytes(),
       .dispatch_count = std::uint64_t{limits.maxComputeWorkGroupCount[0]} * context_.device.local_size(),
       .tile_invocations = std::min<std::uint64_t>(tile_slopes, most),
       .block_shapes = 1},
      context_.packing, data_);
}

void SlopeRun::create_buffers() {
  const Packing& packing = context_.packing;
  const Device& device = context_.device;
  const bool staged = context_.staged_uploads;
  const std::size_t thetas = std::min<std::size_t>(tile_size_, data_.thetas.size());
  const std::size_t indices = std::min<std::size_t>(tile_size_, data_.indices.size());
  theta_buffer_.emplace(device, thetas * packing.node_bytes<kernel::ThetaNode>(), staged);
  index_buffer_.emplace(device, indices * packing.node_bytes<kernel::IndexNode>(), staged);
  slope_buffer_.emplace(device, tile_size_ * packing.node_bytes<kernel::SlopeNode>(), staged);
  rule_buffer_.emplace(device, packing.node_bytes<kernel::RuleNode>(), staged);
  rule_node_buffer_.emplace(device, data_.rule_nodes.size() * packing.node_bytes<std::array<double, 2>>(), staged,
                            packing.rule_texels());
  azimuth_buffer_.emplace(device, tile_size_ * packing.output_bytes<kernel::AzimuthNode>(column_azimuths(data_)),
                          MemoryUse::kReadback);
  Kernels::Bindings bindings;
  bindings.buffers[DOLP_BINDING_THETAS] = theta_buffer_->get();
  bindings.buffers[DOLP_BINDING_INDICES] = index_buffer_->get();
  bindings.buffers[DOLP_BINDING_SLOPES] = slope_buffer_->get();
  bindings.buffers[DOLP_BINDING_RULE] = rule_buffer_->get();
  bindings.texels[DOLP_BINDING_RULE_NODES - kStorageCount] = rule_node_buffer_->texels();
  bindings.buffers[DOLP_BINDING_AZIMUTHS] = azimuth_buffer_->get();
  context_.kernels.bind(bindings);
}

template <class NodeOf>
void SlopeRun::upload(InputBuffer& buffer, std::size_t count, const NodeOf& node_of) {
  context_.packing.pack(count, node_of, scratch_);
  buffer.write(scratch_, context_.stream);
}

void SlopeRun::upload_rule() {
  upload(*rule_node_buffer_, data_.rule_nodes.size(), [&](std::size_t i) { return data_.rule_nodes[i]; });
  upload(*rule_buffer_, 1, [&](std::size_t) { return data_.rule; });
}

std::optional<std::vector<Moments>> SlopeRun::compute(const Progress& progress) {
  std::vector<Moments> moments(request_.size());
  const std::size_t wanted = request_.wanted_count();
  const std::size_t at_once = batch_directions(data_);
  context_.stream.begin();
  upload_rule();
  for (std::size_t first = 0; first < data_.directions; first += at_once) {
    const std::size_t last = std::min(first + at_once, data_.directions);
    const SlopeBatch batch = slope_batch(request_, data_, sampling_, first, last);
    SampledAzimuths azimuths(batch.slopes.size(), data_);
    const std::span<const std::uint32_t> slopes(batch.in_lockstep);
    for (std::size_t done = 0; done < slopes.size();) {
      const std::size_t count = std::min<std::size_t>(tile_size_, slopes.size() - done);
      if (cost_.dispatches > 0) context_.stream.begin();
      run_tile(batch, slopes.subspan(done, count), azimuths);
      done += count;
      const double of_batch = static_cast<double>(done) / static_cast<double>(slopes.size());
      const double share = (static_cast<double>(first) + of_batch * static_cast<double>(last - first)) /
                           static_cast<double>(data_.directions);
      if (progress && !progress(static_cast<std::size_t>(share * static_cast<double>(wanted)), wanted))
        return std::nullopt;
    }
    for (const kernel::AzimuthNode& azimuth : azimuths.nodes) cost_.evaluations += azimuth.evaluations;
    const auto start = std::chrono::steady_clock::now();
    parallel_ranges(batch.samples.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const SlopeSamples& samples = batch.samples[i];
        sampling_.integrate(samples, azimuths, batch.first[i], context_.packing.unit_roundoff(), moments);
      }
    });
    cost_.sums_s += seconds_since(start);
  }
  return moments;
}

void SlopeRun::run_tile(const SlopeBatch& batch, std::span<const std::uint32_t> slopes, SampledAzimuths& azimuths) {
  const Packing& packing = context_.packing;
  CommandStream& stream = context_.stream;
  thetas_.clear();
  indices_.clear();
  nodes_.clear();
  for (const std::uint32_t i : slopes) {
    kernel::SlopeNode& node = nodes_.emplace_back(batch.slopes[i]);
    node.theta = thetas_(static_cast<std::uint32_t>(node.theta));
    node.index = indices_(static_cast<std::uint32_t>(node.index));
  }
  const std::span<const std::uint32_t> thetas = thetas_.used(), indices = indices_.used();
  upload(*slope_buffer_, nodes_.size(), [&](std::size_t i) { return nodes_[i]; });
  upload(*theta_buffer_, thetas.size(), [&](std::size_t i) { return data_.thetas[thetas[i]]; });
  upload(*index_buffer_, indices.size(), [&](std::size_t i) { return data_.indices[indices[i]]; });
  stream.barrier(Barrier::kUploadToKernel);
  stream.dispatch(context_.kernels, context_.kernels.pipeline(slopes_variant(data_)), 0,
                  static_cast<std::uint32_t>(slopes.size()), data_.rule_order, data_.sky.word());
  stream.barrier(Barrier::kKernelToHost);
  cost_.kernel_s += stream.submit_and_wait(context_.tile_timeout_s);
  ++cost_.dispatches;
  const std::size_t per_entry = column_azimuths(data_);
  scratch_.resize(slopes.size() * packing.output_bytes<kernel::AzimuthNode>(per_entry));
  azimuth_buffer_->read(scratch_);
  const std::size_t behind = slopes.size() * packing.node_bytes<kernel::AzimuthNode>();
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    azimuths.nodes[slopes[i]] = packing.read<kernel::AzimuthNode>(scratch_, i);
    packing.read_numbers(scratch_, behind + i * per_entry * packing.real_bytes(), azimuths.columns_of(slopes[i]));
  }
}

}  // namespace dolp::vulkan
