#include "evaluate/vulkan/tiled_run.hpp"

namespace dolp::vulkan {

void TiledRun::create_rule(const KernelData& data, Kernels::Bindings& bindings) {
  using RulePoint = std::array<double, 2>;
  rule_buffer_.emplace(input_buffer<kernel::RuleNode>(1));
  rule_node_buffer_.emplace(input_buffer<RulePoint>(data.rule_nodes.size(), packing_.rule_texels()));
  bindings.buffers[DOLP_BINDING_RULE] = rule_buffer_->get();
  bindings.texels[DOLP_BINDING_RULE_NODES - kStorageCount] = rule_node_buffer_->texels();
}

void TiledRun::upload_rule(const KernelData& data) {
  upload(*rule_node_buffer_, data.rule_nodes.size(), [&](std::size_t i) { return data.rule_nodes[i]; });
  upload(*rule_buffer_, 1, [&](std::size_t) { return data.rule; });
}

void TiledRun::run_kernel(const KernelVariant& variant, std::size_t invocations, const KernelData& data) {
  CommandStream& stream = context_.stream;
  stream.barrier(Barrier::kUploadToKernel);
  stream.dispatch(context_.kernels, context_.kernels.pipeline(variant), 0, static_cast<std::uint32_t>(invocations),
                  data.rule_order, data.sky.word());
  stream.barrier(Barrier::kKernelToHost);
  cost_.kernel_s += stream.submit_and_wait(context_.tile_timeout_s);
  ++cost_.dispatches;
}

}  // namespace dolp::vulkan
