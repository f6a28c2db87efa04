#include "evaluate/vulkan/moments_run.hpp"

#include <algorithm>
#include <numeric>

#include "evaluate/vulkan/result.hpp"

namespace dolp::vulkan {
namespace {

using EntryWords = std::array<std::uint32_t, 4>;
using MaskingNode = std::array<double, 4>;
using RulePoint = std::array<double, 4>;

}  // namespace

MomentsRun::MomentsRun(const RunContext& context, const MomentsRequest& request, std::uint32_t tile_entries,
                       std::uint32_t block_shapes)
    : context_(context),
      request_(request),
      data_(kernel_data(request)),
      sizes_(sizes(tile_entries, block_shapes)),
      thetas_(data_.thetas.size()),
      indices_(request.indices.size()) {
  create_buffers();
}

TileSizes MomentsRun::sizes(std::uint32_t tile_entries, std::uint32_t block_shapes) const {
  const VkPhysicalDeviceLimits& limits = context_.device.limits();
  return tile_sizes({.buffer_bytes = limits.maxStorageBufferRange,
                     .heap_bytes = context_.device.heap_bytes(),
                     .dispatch_count = std::uint64_t{limits.maxComputeWorkGroupCount[0]} * kLocalSize,
                     .tile_entries = std::min<std::uint64_t>(tile_entries, data_.entries.size()),
                     .block_shapes = std::min<std::uint64_t>(block_shapes, data_.shapes.size())},
                    tile_costs(context_.packing));
}

void MomentsRun::create_buffers() {
  const Packing& packing = context_.packing;
  const Device& device = context_.device;
  const bool staged = context_.staged_uploads;
  const std::size_t thetas = std::min<std::size_t>(sizes_.entries, data_.thetas.size());
  const std::size_t indices = std::min<std::size_t>(sizes_.entries, data_.indices.size());
  const std::size_t tables = data_.needs_masking_table() ? sizes_.shapes : 0;
  theta_buffer_.emplace(device, thetas * packing.node_bytes<kernel::ThetaNode>(), staged);
  shape_buffer_.emplace(device, sizes_.shapes * packing.node_bytes<kernel::ShapeNode>(), staged);
  index_buffer_.emplace(device, indices * packing.node_bytes<kernel::IndexNode>(), staged);
  entry_buffer_.emplace(device, sizes_.entries * sizeof(EntryWords), staged);
  rule_buffer_.emplace(device, packing.node_bytes<kernel::RuleNode>(), staged);
  rule_node_buffer_.emplace(device, data_.rule_nodes.size() * packing.node_bytes<RulePoint>(), staged);
  masking_buffer_.emplace(device, tables * packing.masking_nodes() * packing.node_bytes<MaskingNode>(),
                          MemoryUse::kDeviceOnly);
  moments_buffer_.emplace(device, sizes_.entries * packing.node_bytes<kernel::MomentsNode>(), MemoryUse::kReadback);

  std::array<VkBuffer, kBindingCount> buffers{};
  buffers[DOLP_BINDING_THETAS] = theta_buffer_->get();
  buffers[DOLP_BINDING_SHAPES] = shape_buffer_->get();
  buffers[DOLP_BINDING_INDICES] = index_buffer_->get();
  buffers[DOLP_BINDING_ENTRIES] = entry_buffer_->get();
  buffers[DOLP_BINDING_RULE] = rule_buffer_->get();
  buffers[DOLP_BINDING_RULE_NODES] = rule_node_buffer_->get();
  buffers[DOLP_BINDING_MASKING_TABLE] = masking_buffer_->get();
  buffers[DOLP_BINDING_MOMENTS] = moments_buffer_->get();
  context_.kernels.bind(buffers);
}

std::optional<std::vector<Moments>> MomentsRun::compute(const Progress& progress) {
  std::vector<Moments> moments(data_.entries.size());
  std::size_t done = 0;
  for (const Block& block : blocks_of(data_.entries, data_.shapes.size(), sizes_.shapes)) {
    start_block(block);
    const std::span<const std::size_t> entries(block.entries);
    for (std::size_t first = 0; first < entries.size(); first += sizes_.entries) {
      const auto tile = entries.subspan(first, std::min<std::size_t>(sizes_.entries, entries.size() - first));
      run_tile(block, tile, moments);
      done += tile.size();
      if (progress && !progress(done, moments.size())) return std::nullopt;
    }
  }
  return moments;
}

template <class Node>
void MomentsRun::upload(const std::vector<Node>& list, std::span<const std::uint32_t> members, InputBuffer& buffer) {
  scratch_.clear();
  for (const std::uint32_t member : members) context_.packing.append(list[member], scratch_);
  buffer.write(scratch_, context_.stream);
}

void MomentsRun::start_block(const Block& block) {
  std::vector<std::uint32_t> shapes(block.shape_count), nodes(data_.rule_nodes.size());
  std::iota(shapes.begin(), shapes.end(), block.first_shape);
  std::iota(nodes.begin(), nodes.end(), 0U);
  CommandStream& stream = context_.stream;
  stream.begin();
  upload(data_.shapes, shapes, *shape_buffer_);
  upload(data_.rule_nodes, nodes, *rule_node_buffer_);
  scratch_.clear();
  context_.packing.append(data_.rule, scratch_);
  rule_buffer_->write(scratch_, stream);
  stream.barrier(Barrier::kUploadToKernel);
  if (data_.needs_masking_table()) {
    stream.dispatch(context_.kernels, context_.kernels.masking_table(data_.distribution, data_.masking), 0,
                    block.shape_count);
    stream.barrier(Barrier::kKernelToKernel);
    ++cost_.dispatches;
  }
  cost_.kernel_s += stream.submit_and_wait(context_.tile_timeout_s);
}

void MomentsRun::upload_tile(const Block& block, std::span<const std::size_t> entries) {
  thetas_.clear();
  indices_.clear();
  std::vector<EntryWords> words;
  words.reserve(entries.size());
  for (const std::size_t position : entries) {
    const MomentsEntry& entry = data_.entries[position];
    words.push_back({thetas_(entry.theta), entry.shape - block.first_shape, indices_(entry.index), 0U});
  }
  entry_buffer_->write(std::as_bytes(std::span(words)), context_.stream);
  upload(data_.thetas, thetas_.used(), *theta_buffer_);
  upload(data_.indices, indices_.used(), *index_buffer_);
}

void MomentsRun::run_tile(const Block& block, std::span<const std::size_t> entries, std::span<Moments> moments) {
  CommandStream& stream = context_.stream;
  stream.begin();
  upload_tile(block, entries);
  stream.barrier(Barrier::kUploadToKernel);
  stream.dispatch(context_.kernels, context_.kernels.moments(data_.distribution, data_.masking), 0,
                  static_cast<std::uint32_t>(entries.size()));
  stream.barrier(Barrier::kKernelToHost);
  cost_.kernel_s += stream.submit_and_wait(context_.tile_timeout_s);
  ++cost_.dispatches;

  scratch_.resize(entries.size() * context_.packing.node_bytes<kernel::MomentsNode>());
  moments_buffer_->read(scratch_);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto node = context_.packing.read<kernel::MomentsNode>(scratch_, i);
    moments[entries[i]] = moments_from_kernel(node, data_, data_.entries[entries[i]], context_.packing.unit_roundoff());
    cost_.evaluations += node.evaluations;
  }
}

}  // namespace dolp::vulkan
