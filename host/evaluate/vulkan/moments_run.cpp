#include "evaluate/vulkan/moments_run.hpp"

#include <algorithm>
#include <future>
#include <numeric>

#include "base/parallel_ranges.hpp"
#include "evaluate/vulkan/result.hpp"

namespace dolp::vulkan {
namespace {

using EntryWords = std::array<std::uint32_t, 4>;
using MaskingNode = std::array<double, 4>;
using RulePoint = std::array<double, 2>;

// What a thread takes at a time.
constexpr std::size_t kGroupsAtOnce = 1024;
constexpr std::size_t kEntriesAtOnce = 4096;

}  // namespace

MomentsRun::MomentsRun(const RunContext& context, const MomentsRequest& request, std::uint32_t tile_invocations,
                       std::uint32_t block_shapes)
    : context_(context),
      request_(request),
      data_(kernel_data(request)),
      grouping_(grouped(data_, context.groups_small_requests)),
      sizes_(sizes(tile_invocations, block_shapes)),
      thetas_(data_.thetas.size()),
      indices_(request.indices.size()) {
  create_buffers();
}

TileSizes MomentsRun::sizes(std::uint32_t tile_invocations, std::uint32_t block_shapes) const {
  const VkPhysicalDeviceLimits& limits = context_.device.limits();
  return tile_sizes(
      {.buffer_bytes = limits.maxStorageBufferRange,
       .heap_bytes = context_.device.heap_bytes(),
       .dispatch_count = std::uint64_t{limits.maxComputeWorkGroupCount[0]} * kLocalSize,
       .tile_invocations = std::min<std::uint64_t>(tile_invocations, grouping_.groups.size() * DOLP_MAX_PIECES),
       .block_shapes = std::min<std::uint64_t>(block_shapes, data_.shapes.size())},
      tile_costs(context_.packing, grouping_.size));
}

void MomentsRun::create_buffers() {
  const Packing& packing = context_.packing;
  const Device& device = context_.device;
  const bool staged = context_.staged_uploads;
  const std::size_t thetas = std::min<std::size_t>(sizes_.invocations, data_.thetas.size());
  const std::size_t indices = std::min<std::size_t>(sizes_.invocations, data_.indices.size());
  const std::size_t tables = data_.needs_masking_table() ? sizes_.shapes : 0;
  theta_buffer_.emplace(device, thetas * packing.node_bytes<kernel::ThetaNode>(), staged);
  shape_buffer_.emplace(device, sizes_.shapes * packing.node_bytes<kernel::ShapeNode>(), staged);
  index_buffer_.emplace(device, indices * packing.node_bytes<kernel::IndexNode>(), staged);
  entry_buffer_.emplace(device, sizes_.invocations * sizeof(EntryWords), staged);
  rule_buffer_.emplace(device, packing.node_bytes<kernel::RuleNode>(), staged);
  rule_node_buffer_.emplace(device, data_.rule_nodes.size() * packing.node_bytes<RulePoint>(), staged);
  masking_buffer_.emplace(device, tables * packing.masking_nodes() * packing.node_bytes<MaskingNode>(),
                          MemoryUse::kDeviceOnly);
  moments_buffer_.emplace(device, sizes_.invocations * grouping_.size * packing.node_bytes<kernel::MomentsNode>(),
                          MemoryUse::kReadback);

  std::array<VkBuffer, kBindingCount> buffers{};
  buffers[DOLP_BINDING_THETAS] = theta_buffer_->get();
  buffers[DOLP_BINDING_SHAPES] = shape_buffer_->get();
  buffers[DOLP_BINDING_INDICES] = index_buffer_->get();
  buffers[DOLP_BINDING_TASKS] = entry_buffer_->get();
  buffers[DOLP_BINDING_RULE] = rule_buffer_->get();
  buffers[DOLP_BINDING_RULE_NODES] = rule_node_buffer_->get();
  buffers[DOLP_BINDING_MASKING_TABLE] = masking_buffer_->get();
  buffers[DOLP_BINDING_MOMENTS] = moments_buffer_->get();
  context_.kernels.bind(buffers);
}

void MomentsRun::create_pipelines() {
  std::future<void> tables;
  if (data_.needs_masking_table()) {
    tables = std::async(std::launch::async, [&] { context_.kernels.pipeline(masking_table_variant(data_)); });
  }
  context_.kernels.pipeline(moments_variant(data_, grouping_.size));
  if (tables.valid()) tables.get();
}

std::optional<std::vector<Moments>> MomentsRun::compute(const Progress& progress) {
  std::vector<kernel::MomentsNode> results(grouping_.groups.size() * grouping_.size);
  for (const Block& block : blocks_of(grouping_, sizes_.shapes)) {
    start_block(block);
    const std::vector<GroupPiece> pieces = pieces_of(grouping_, data_, block.first_group, block.group_count);
    for (std::size_t first = 0; first < pieces.size(); first += sizes_.invocations) {
      const std::size_t count = std::min<std::size_t>(sizes_.invocations, pieces.size() - first);
      run_tile(block, std::span(pieces).subspan(first, count), results);
      const double share = (block.first_group + block.group_count * static_cast<double>(first + count) /
                                                    static_cast<double>(pieces.size())) /
                           static_cast<double>(grouping_.groups.size());
      const auto done = static_cast<std::size_t>(share * static_cast<double>(data_.entries.size()));
      if (progress && !progress(done, data_.entries.size())) return std::nullopt;
    }
  }
  return moments_of_entries(results);
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
  upload(grouping_.shapes, shapes, *shape_buffer_);
  upload(data_.rule_nodes, nodes, *rule_node_buffer_);
  scratch_.clear();
  context_.packing.append(data_.rule, scratch_);
  rule_buffer_->write(scratch_, stream);
  stream.barrier(Barrier::kUploadToKernel);
  if (data_.needs_masking_table()) {
    stream.dispatch(context_.kernels, context_.kernels.pipeline(masking_table_variant(data_)), 0, block.shape_count,
                    data_.rule_order);
    stream.barrier(Barrier::kKernelToKernel);
    ++cost_.dispatches;
  }
  cost_.kernel_s += stream.submit_and_wait(context_.tile_timeout_s);
}

void MomentsRun::upload_tile(const Block& block, std::span<const GroupPiece> pieces) {
  thetas_.clear();
  indices_.clear();
  std::vector<EntryWords> words;
  words.reserve(pieces.size());
  for (const GroupPiece& own : pieces) {
    const EntryGroup& group = grouping_.groups[own.group];
    const ShapeFamily& family = grouping_.families[group.family];
    words.push_back({thetas_(group.theta), family.first - block.first_shape, indices_(group.index),
                     task_word(data_.pieces[group.theta], own.piece, family.count)});
  }
  entry_buffer_->write(std::as_bytes(std::span(words)), context_.stream);
  upload(data_.thetas, thetas_.used(), *theta_buffer_);
  upload(data_.indices, indices_.used(), *index_buffer_);
}

void MomentsRun::run_tile(const Block& block, std::span<const GroupPiece> pieces,
                          std::span<kernel::MomentsNode> results) {
  CommandStream& stream = context_.stream;
  stream.begin();
  upload_tile(block, pieces);
  stream.barrier(Barrier::kUploadToKernel);
  stream.dispatch(context_.kernels, context_.kernels.pipeline(moments_variant(data_, grouping_.size)), 0,
                  static_cast<std::uint32_t>(pieces.size()), data_.rule_order);
  stream.barrier(Barrier::kKernelToHost);
  cost_.kernel_s += stream.submit_and_wait(context_.tile_timeout_s);
  ++cost_.dispatches;

  add_pieces(pieces, results);
}

void MomentsRun::add_pieces(std::span<const GroupPiece> pieces, std::span<kernel::MomentsNode> results) {
  scratch_.resize(pieces.size() * grouping_.size * context_.packing.node_bytes<kernel::MomentsNode>());
  moments_buffer_->read(scratch_);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    cost_.evaluations += context_.packing.read<kernel::MomentsNode>(scratch_, i * grouping_.size).evaluations;
  }
  // The pieces of a group are summed in their order, whoever does it: each range has its groups.
  const auto [least, most] = std::ranges::minmax(pieces, {}, &GroupPiece::group);
  const std::uint32_t first_group = least.group;
  parallel_ranges(most.group - least.group + std::size_t{1}, kGroupsAtOnce, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const std::size_t group = pieces[i].group - first_group;
      if (group < first || group >= last) continue;
      const std::uint32_t used = grouping_.groups[pieces[i].group].used;
      for (std::uint32_t g = 0; g < grouping_.size; ++g) {
        auto node = context_.packing.read<kernel::MomentsNode>(scratch_, i * grouping_.size + g);
        node.evaluations /= used;
        add_piece(results[pieces[i].group * std::size_t{grouping_.size} + g], node);
      }
    }
  });
}

std::vector<Moments> MomentsRun::moments_of_entries(std::span<const kernel::MomentsNode> results) const {
  std::vector<Moments> moments(data_.entries.size());
  parallel_ranges(moments.size(), kEntriesAtOnce, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const EntryPlace& place = grouping_.places[i];
      moments[i] = moments_from_kernel(results[place.group * std::size_t{grouping_.size} + place.member], data_,
                                       data_.entries[i], context_.packing.unit_roundoff());
    }
  });
  return moments;
}

}  // namespace dolp::vulkan
