#include "evaluate/vulkan/tiled_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace dolp::vulkan {
namespace {

using Node = std::array<double, 2>;  // a rule node
// The five sections of Gauss rules fit in the texels of every device (rule_node() in shaders/physics/buffers.glsl).
static_assert(5 * DOLP_MAX_ORDER * (DOLP_MAX_ORDER + 1) / 2 <= 65536);
static_assert(real_count<kernel::RuleNode>() % 2 == 0, "std430 would put a gap between the RuleNode and stored nodes");

}  // namespace

InputBuffer& TiledRun::kept_input(std::size_t slot, std::uint32_t binding, std::size_t bytes, VkFormat texels) {
  std::optional<InputBuffer>& kept = context_.buffers.inputs[slot][binding];
  if (!kept || !kept->fits(bytes, texels)) kept.emplace(context_.device, bytes, context_.staged_uploads, texels);
  return *kept;
}

Buffer& TiledRun::kept_buffer(std::optional<Buffer>& kept, std::size_t bytes, MemoryUse use, VkFormat texels) const {
  if (!kept || !kept->fits(bytes, texels)) kept.emplace(context_.device, bytes, use, texels);
  return *kept;
}

void TiledRun::bind_input(std::size_t slot, std::uint32_t binding, InputBuffer& buffer) {
  inputs_[slot][binding] = &buffer;
  if (binding < kStorageCount) {
    bindings_[slot].buffers[binding] = buffer.get();
  } else {
    bindings_[slot].texels[binding - kStorageCount] = buffer.texels();
  }
}

void TiledRun::add_shared_input(std::uint32_t binding, std::size_t bytes, VkFormat texels) {
  InputBuffer& buffer = kept_input(0, binding, bytes, texels);
  for (std::size_t slot = 0; slot < kMostInFlight; ++slot) bind_input(slot, binding, buffer);
}

void TiledRun::add_tile_input(std::uint32_t binding, std::size_t bytes) {
  for (std::size_t slot = 0; slot < kMostInFlight; ++slot) {
    bind_input(slot, binding, kept_input(slot, binding, bytes, VK_FORMAT_UNDEFINED));
  }
}

void TiledRun::add_masking_tables(std::size_t shapes) {
  const Buffer& tables =
      kept_buffer(context_.buffers.masking, shapes * packing_.masking_nodes() * packing_.node_bytes<MaskingNode>(),
                  MemoryUse::kDeviceOnly, packing_.masking_texels());
  for (Kernels::Bindings& bindings : bindings_) {
    bindings.buffers[DOLP_BINDING_MASKING_TABLE] = tables.get();
    bindings.texels[DOLP_BINDING_MASKING_NODES - kStorageCount] = tables.texels();
  }
}

void TiledRun::add_results(std::uint32_t binding, std::size_t bytes, const KernelData& data,
                           const KernelVariant& variant) {
  variant_ = variant;
  texel_nodes_ = std::min<std::size_t>(data.rule_nodes.size(), context_.description.max_texels);
  const std::size_t stored_nodes = texel_nodes_ < data.rule_nodes.size() ? data.rule_nodes.size() : 0;
  variant_.has_stored_nodes = stored_nodes > 0;
  const std::size_t rule_bytes = packing_.node_bytes<kernel::RuleNode>() + stored_nodes * packing_.node_bytes<Node>();
  if (rule_bytes > context_.description.max_storage_buffer_bytes) {
    throw DeviceError(
        fmt::format("{}: the tables of reflectances need a buffer of {} bytes, and the device allows {}: "
                    "use fewer wavelengths, or the evaluator cpu",
                    context_.description.name, rule_bytes, context_.description.max_storage_buffer_bytes));
  }
  add_shared_input(DOLP_BINDING_RULE, rule_bytes);
  add_shared_input(DOLP_BINDING_RULE_NODES, texel_nodes_ * packing_.node_bytes<Node>(), packing_.rule_texels());
  for (std::size_t slot = 0; slot < kMostInFlight; ++slot) {
    bindings_[slot].buffers[binding] =
        kept_buffer(context_.buffers.results[slot], bytes, MemoryUse::kReadback, VK_FORMAT_UNDEFINED).get();
    context_.kernels.bind(bindings_[slot], slot);
  }
}

void TiledRun::upload_rule(const KernelData& data) {
  const auto node = [&](std::size_t i) { return data.rule_nodes[i]; };
  upload(DOLP_BINDING_RULE_NODES, texel_nodes_, node);
  std::vector<std::byte> rule;
  packing_.pack(
      1, [&](std::size_t) { return data.rule; }, rule);
  packing_.pack(variant_.has_stored_nodes ? data.rule_nodes.size() : 0, node, scratch_);
  rule.insert(rule.end(), scratch_.begin(), scratch_.end());
  upload_bytes(DOLP_BINDING_RULE, rule);
}

void TiledRun::begin_tile() {
  if (context_.stream.in_flight() == kMostInFlight) finish_tile();
  context_.stream.begin();
}

void TiledRun::submit_tile(std::size_t invocations, std::size_t result_bytes, const KernelData& data, UseResults use) {
  CommandStream& stream = context_.stream;
  stream.barrier(Barrier::kUploadToKernel);
  stream.dispatch(context_.kernels, context_.kernels.pipeline(variant_), 0, static_cast<std::uint32_t>(invocations),
                  data.rule_order, data.sky.word());
  stream.barrier(Barrier::kKernelToHost);
  ++cost_.dispatches;
  submit({&pace_, invocations, result_bytes, std::move(use)});
}

void TiledRun::submit(Pending pending) {
  pending_[context_.stream.slot()] = std::move(pending);
  context_.stream.submit();
}

void TiledRun::finish_tile() {
  const std::size_t slot = context_.stream.oldest_slot();
  const Pending& tile = pending_[slot];
  const double seconds = context_.stream.wait(context_.tile_timeout_s);
  cost_.kernel_s += seconds;
  tile.pace->note(tile.invocations, seconds);
  if (!tile.use) return;
  scratch_.resize(tile.result_bytes);
  context_.buffers.results[slot]->read(scratch_);
  tile.use();
}

void TiledRun::finish_tiles() {
  while (context_.stream.in_flight() > 0) finish_tile();
}

void TiledRun::note_progress(const Progress& progress, double share, std::size_t wanted) {
  if (progress && !progress(static_cast<std::size_t>(share * static_cast<double>(wanted)), wanted)) throw Cancelled();
}

}  // namespace dolp::vulkan
