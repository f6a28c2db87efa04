// Base of all kernel runs: uploads, the buffers of the rule, and the dispatch of a tile.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "device/buffer.hpp"
#include "evaluate/vulkan/command_stream.hpp"
#include "evaluate/vulkan/input_buffer.hpp"
#include "evaluate/vulkan/kernels.hpp"
#include "evaluate/vulkan/packing.hpp"

namespace dolp::vulkan {

/// Objects that a run uses; they outlive the run.
struct KernelContext {
  const Device& device;
  const dolp::Device& description;
  Kernels& kernels;
  CommandStream& stream;
  bool staged_uploads = false;
  double tile_timeout_s = 0.0;
};

/// Cost of a run so far.
struct RunCost {
  std::uint64_t dispatches = 0;
  double evaluations = 0.0;
  double kernel_s = 0.0;
  double sums_s = 0.0;  ///< EvaluationReport::sums_s
};

/// A request on the device, tile by tile. The inputs of a tile are recorded, then its kernel runs.
class TiledRun {
 public:
  const RunCost& cost() const { return cost_; }

 protected:
  TiledRun(const KernelContext& context, const Packing& packing) : context_(context), packing_(packing) {}

  template <class Node>
  InputBuffer input_buffer(std::size_t count, VkFormat texels = VK_FORMAT_UNDEFINED) const {
    return {context_.device, count * packing_.node_bytes<Node>(), context_.staged_uploads, texels};
  }
  template <class NodeOf>
  void upload(InputBuffer& buffer, std::size_t count, const NodeOf& node_of) {
    packing_.pack(count, node_of, scratch_);
    buffer.write(scratch_, context_.stream);
  }
  /// Makes the buffers of the rule, and adds them to the bindings.
  void create_rule(const KernelData& data, Kernels::Bindings& bindings);
  /// Records the upload of the rule.
  void upload_rule(const KernelData& data);
  /// Runs the kernel on a tile whose inputs are recorded, and waits for it.
  void run_kernel(const KernelVariant& variant, std::size_t invocations, const KernelData& data);

  KernelContext context_;
  Packing packing_;
  std::vector<std::byte> scratch_;
  RunCost cost_;

 private:
  std::optional<InputBuffer> rule_buffer_, rule_node_buffer_;
};

}  // namespace dolp::vulkan
