#include <algorithm>

#include "base/parallel_ranges.hpp"
#include "evaluate/vulkan/tiled_run.hpp"
#include "evaluate/vulkan/tiles.hpp"

namespace dolp::vulkan {
namespace {

class ScatteringRun final : public Run<ScatteringMatrix> {
 public:
  ScatteringRun(const KernelContext& context, const ScatteringRequest& request, const VulkanOptions& options)
      : Run(context, request.precision), request_(request), tiles_(request, context.description, options) {
    add_inputs<kernel::BeamNode>(DOLP_BINDING_BEAMS, tiles_.beams);
    add_results(DOLP_BINDING_MUELLERS, tiles_.beams * packing_.node_bytes<kernel::MuellerNode>(), tiles_.plan.data(),
                mueller_variant(request));
  }

  std::optional<std::vector<ScatteringMatrix>> compute(const Progress& progress) override {
    std::vector<ScatteringMatrix> matrices(request_.entries.size());
    const std::span<const ScatteringEntry> entries(request_.entries);
    context_.stream.begin();
    upload_rule(tiles_.plan.data());
    for (std::size_t first = 0; first < entries.size(); first += tiles_.beams) {
      const std::size_t count = std::min<std::size_t>(tiles_.beams, entries.size() - first);
      if (first > 0) context_.stream.begin();
      run_tile(entries.subspan(first, count), std::span(matrices).subspan(first, count));
      if (progress && !progress(first + count, matrices.size())) return std::nullopt;
    }
    return matrices;
  }

 private:
  void run_tile(std::span<const ScatteringEntry> entries, std::span<ScatteringMatrix> matrices) {
    beams_.clear();
    for (const ScatteringEntry& entry : entries) beams_.push_back(tiles_.plan(entry));
    upload(DOLP_BINDING_BEAMS, beams_.size(), [&](std::size_t i) { return beams_[i].node; });
    run_kernel(entries.size(), entries.size() * packing_.node_bytes<kernel::MuellerNode>(), tiles_.plan.data());
    const auto finish = [&](std::size_t i) {
      const auto node = packing_.read<kernel::MuellerNode>(scratch_, i);
      matrices[i] = tiles_.plan.matrix(node, beams_[i], entries[i], packing_.unit_roundoff());
    };
    parallel_for(entries.size(), finish, {});
  }

  const ScatteringRequest& request_;
  BeamTiles tiles_;
  std::vector<Beam> beams_;
};

}  // namespace

std::unique_ptr<Run<ScatteringMatrix>> scattering_run(const KernelContext& context, const ScatteringRequest& request,
                                                      const VulkanOptions& options) {
  return std::make_unique<ScatteringRun>(context, request, options);
}

KernelVariant mueller_variant(const ScatteringRequest& request) {
  return {EntryPoint::kMueller, request.distribution, request.masking};
}

}  // namespace dolp::vulkan
