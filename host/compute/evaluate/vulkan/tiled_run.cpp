#include "evaluate/vulkan/tiled_run.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dolp::vulkan {
namespace {

using Node = std::array<double, 2>;  // a rule node
// The five sections of Gauss rules fit in the texels of every device (rule_node() in shaders/physics/buffers.glsl).
static_assert(5 * DOLP_MAX_ORDER * (DOLP_MAX_ORDER + 1) / 2 <= 65536);
static_assert(real_count<kernel::RuleNode>() % 2 == 0, "std430 would put a gap between the RuleNode and stored nodes");

}  // namespace

void TiledRun::add_input(std::uint32_t binding, std::size_t bytes, VkFormat texels) {
  const InputBuffer& buffer = inputs_[binding].emplace(context_.device, bytes, context_.staged_uploads, texels);
  if (binding < kStorageCount) {
    bindings_.buffers[binding] = buffer.get();
  } else {
    bindings_.texels[binding - kStorageCount] = buffer.texels();
  }
}

void TiledRun::add_results(std::uint32_t binding, std::size_t bytes, const KernelData& data,
                           const KernelVariant& variant) {
  variant_ = variant;
  bindings_.buffers[binding] = results_.emplace(context_.device, bytes, MemoryUse::kReadback).get();
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
  add_input(DOLP_BINDING_RULE, rule_bytes);
  add_inputs<Node>(DOLP_BINDING_RULE_NODES, texel_nodes_, packing_.rule_texels());
  context_.kernels.bind(bindings_);
}

void TiledRun::upload_rule(const KernelData& data) {
  const auto node = [&](std::size_t i) { return data.rule_nodes[i]; };
  upload(DOLP_BINDING_RULE_NODES, texel_nodes_, node);
  std::vector<std::byte> rule;
  packing_.pack(
      1, [&](std::size_t) { return data.rule; }, rule);
  packing_.pack(variant_.has_stored_nodes ? data.rule_nodes.size() : 0, node, scratch_);
  rule.insert(rule.end(), scratch_.begin(), scratch_.end());
  inputs_[DOLP_BINDING_RULE]->write(rule, context_.stream);
}

void TiledRun::run_kernel(std::size_t invocations, std::size_t result_bytes, const KernelData& data) {
  CommandStream& stream = context_.stream;
  stream.barrier(Barrier::kUploadToKernel);
  stream.dispatch(context_.kernels, context_.kernels.pipeline(variant_), 0, static_cast<std::uint32_t>(invocations),
                  data.rule_order, data.sky.word());
  stream.barrier(Barrier::kKernelToHost);
  cost_.kernel_s += stream.submit_and_wait(context_.tile_timeout_s);
  ++cost_.dispatches;
  scratch_.resize(result_bytes);
  results_->read(scratch_);
}

}  // namespace dolp::vulkan
