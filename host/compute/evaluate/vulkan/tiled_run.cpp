#include "evaluate/vulkan/tiled_run.hpp"

namespace dolp::vulkan {

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
  add_inputs<kernel::RuleNode>(DOLP_BINDING_RULE, 1);
  add_inputs<std::array<double, 2>>(DOLP_BINDING_RULE_NODES, data.rule_nodes.size(), packing_.rule_texels());
  context_.kernels.bind(bindings_);
}

void TiledRun::upload_rule(const KernelData& data) {
  upload(DOLP_BINDING_RULE_NODES, data.rule_nodes.size(), [&](std::size_t i) { return data.rule_nodes[i]; });
  upload(DOLP_BINDING_RULE, 1, [&](std::size_t) { return data.rule; });
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
