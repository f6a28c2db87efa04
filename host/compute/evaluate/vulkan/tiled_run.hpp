// Runs a request on a device, tile by tile. A tile is what one dispatch of a kernel computes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <dolp/errors.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "evaluate/vulkan/command_stream.hpp"
#include "evaluate/vulkan/kernels.hpp"
#include "evaluate/vulkan/packing.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"

namespace dolp::vulkan {

struct KernelContext {
  const Device& device;
  const dolp::Device& description;
  Kernels& kernels;
  CommandStream& stream;
  double unit_roundoff = 0.0;  ///< for the error bounds of moments_from_kernel()
  bool staged_uploads = false;
  double tile_timeout_s = 0.0;
};

/// Base class of the runs, which compute one request each. For each tile, a run uploads inputs and runs the kernel.
class TiledRun {
 public:
  virtual ~TiledRun() = default;
  /// Creates the pipelines before the computation, so that the time for them is measured separately.
  virtual void create_pipelines() { context_.kernels.pipeline(variant_); }
  /// Returns one result per entry of the request, or nothing if `progress` returned false. Errors: DeviceError.
  virtual std::optional<std::vector<Moments>> compute(const Progress& progress) = 0;
  const Work& cost() const { return cost_; }

 protected:
  TiledRun(const KernelContext& context, Precision precision)
      : context_(context), packing_(precision == Precision::kDouble) {}

  void add_input(std::uint32_t binding, std::size_t bytes, VkFormat texels = VK_FORMAT_UNDEFINED);
  template <class Node>
  void add_inputs(std::uint32_t binding, std::size_t count, VkFormat texels = VK_FORMAT_UNDEFINED) {
    add_input(binding, count * packing_.node_bytes<Node>(), texels);
  }
  void add_results(std::uint32_t binding, std::size_t bytes, const KernelData& data, const KernelVariant& variant);
  template <class NodeOf>
  void upload(std::uint32_t binding, std::size_t count, const NodeOf& make_node) {
    packing_.pack(count, make_node, scratch_);
    inputs_[binding]->write(scratch_, context_.stream);
  }
  void upload_rule(const KernelData& data);
  /// Calls `progress` with the number of finished entries, `share` times `wanted`. Returns false if the caller cancels.
  static bool goes_on(const Progress& progress, double share, std::size_t wanted) {
    return !progress || progress(static_cast<std::size_t>(share * static_cast<double>(wanted)), wanted);
  }
  /// Runs the kernel on a tile, waits for its end, and reads the results to `scratch_`. upload() must come first.
  void run_kernel(std::size_t invocations, std::size_t result_bytes, const KernelData& data);

  KernelContext context_;
  Packing packing_;
  KernelVariant variant_;
  Kernels::Bindings bindings_;
  std::array<std::optional<InputBuffer>, kStorageCount + kTexelCount> inputs_;
  std::optional<Buffer> results_;
  std::size_t texel_nodes_ = 0;  ///< rule nodes in the texel buffer; if some do not fit, a storage buffer has all
  std::vector<std::byte> scratch_;
  Work cost_;
};

std::unique_ptr<TiledRun> row_run(const KernelContext& context, const MomentsRequest& request,
                                  const VulkanOptions& options);
std::unique_ptr<TiledRun> slope_run(const KernelContext& context, const MomentsRequest& request,
                                    const VulkanOptions& options);

}  // namespace dolp::vulkan
