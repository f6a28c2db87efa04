#include "evaluate/vulkan/scattering_run.hpp"

#include <algorithm>

#include "base/parallel_ranges.hpp"

namespace dolp::vulkan {

KernelVariant mueller_variant(const ScatteringRequest& request) {
  return {EntryPoint::kMueller, request.distribution, request.masking};
}

ScatteringRun::ScatteringRun(const KernelContext& context, const ScatteringRequest& request, std::uint32_t tile_entries)
    : context_(context), request_(request), plan_(request), tile_size_(tile_size(tile_entries)) {
  create_buffers();
}

std::uint32_t ScatteringRun::tile_size(std::uint32_t tile_entries) const {
  const VkPhysicalDeviceLimits& limits = context_.device.limits();
  return tile_sizes({.buffer_bytes = limits.maxStorageBufferRange,
                     .heap_bytes = context_.device.heap_bytes(),
                     .dispatch_count = std::uint64_t{limits.maxComputeWorkGroupCount[0]} * context_.device.local_size(),
                     .tile_invocations = std::min<std::uint64_t>(tile_entries, request_.entries.size()),
                     .block_shapes = 1},
                    scattering_tile_costs(context_.packing))
      .invocations;
}

void ScatteringRun::create_buffers() {
  const Packing& packing = context_.packing;
  const bool staged = context_.staged_uploads;
  const std::size_t rule_bytes = plan_.data().rule_nodes.size() * packing.node_bytes<std::array<double, 2>>();
  beam_buffer_.emplace(context_.device, tile_size_ * packing.node_bytes<kernel::BeamNode>(), staged);
  rule_node_buffer_.emplace(context_.device, rule_bytes, staged, packing.rule_texels());
  mueller_buffer_.emplace(context_.device, tile_size_ * packing.node_bytes<kernel::MuellerNode>(),
                          MemoryUse::kReadback);
  Kernels::Bindings bindings;
  bindings.buffers[DOLP_BINDING_BEAMS] = beam_buffer_->get();
  bindings.texels[DOLP_BINDING_RULE_NODES - kStorageCount] = rule_node_buffer_->texels();
  bindings.buffers[DOLP_BINDING_MUELLERS] = mueller_buffer_->get();
  context_.kernels.bind(bindings);
}

std::optional<std::vector<ScatteringMatrix>> ScatteringRun::compute(const Progress& progress) {
  std::vector<ScatteringMatrix> matrices(request_.entries.size());
  const std::span<const ScatteringEntry> entries(request_.entries);
  context_.stream.begin();
  upload_rule_nodes();
  for (std::size_t first = 0; first < entries.size(); first += tile_size_) {
    const std::size_t count = std::min<std::size_t>(tile_size_, entries.size() - first);
    if (first > 0) context_.stream.begin();
    run_tile(entries.subspan(first, count), std::span(matrices).subspan(first, count));
    if (progress && !progress(first + count, matrices.size())) return std::nullopt;
  }
  return matrices;
}

void ScatteringRun::upload_rule_nodes() {
  const auto& nodes = plan_.data().rule_nodes;
  context_.packing.pack(
      nodes.size(), [&](std::size_t i) { return nodes[i]; }, scratch_);
  rule_node_buffer_->write(scratch_, context_.stream);
}

void ScatteringRun::run_tile(std::span<const ScatteringEntry> entries, std::span<ScatteringMatrix> matrices) {
  const Packing& packing = context_.packing;
  CommandStream& stream = context_.stream;
  beams_.clear();
  scratch_.clear();
  for (const ScatteringEntry& entry : entries) {
    beams_.push_back(plan_(entry));
    packing.append(beams_.back().node, scratch_);
  }
  beam_buffer_->write(scratch_, stream);
  stream.barrier(Barrier::kUploadToKernel);
  stream.dispatch(context_.kernels, context_.kernels.pipeline(mueller_variant(request_)), 0,
                  static_cast<std::uint32_t>(entries.size()), plan_.data().rule_order);
  stream.barrier(Barrier::kKernelToHost);
  cost_.kernel_s += stream.submit_and_wait(context_.tile_timeout_s);
  ++cost_.dispatches;

  scratch_.resize(entries.size() * packing.node_bytes<kernel::MuellerNode>());
  mueller_buffer_->read(scratch_);
  const auto finish = [&](std::size_t i) {
    const auto node = packing.read<kernel::MuellerNode>(scratch_, i);
    matrices[i] = plan_.matrix(node, beams_[i], entries[i], packing.unit_roundoff());
  };
  parallel_for(entries.size(), finish, {});
}

}  // namespace dolp::vulkan
