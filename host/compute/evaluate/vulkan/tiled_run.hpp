// Runs a request on a device, tile by tile.
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

/// The buffers of a request on the device. The inputs of a tile are recorded, then its kernel runs.
class TiledRun {
 public:
  virtual ~TiledRun() = default;
  /// Creates the pipelines before the computation, so that their time is measured separately.
  virtual void create_pipelines() = 0;
  const RunCost& cost() const { return cost_; }

 protected:
  TiledRun(const KernelContext& context, Precision precision)
      : context_(context), packing_(precision == Precision::kDouble) {}

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

template <class Result>
class Run : public TiledRun {
 public:
  /// The results of the wanted entries, at their positions in the request; nothing if `progress` returned false.
  /// Errors: DeviceError.
  virtual std::optional<std::vector<Result>> compute(const Progress& progress) = 0;

 protected:
  using TiledRun::TiledRun;
};

/// A run for moments in kernel rows.
std::unique_ptr<Run<Moments>> row_run(const KernelContext& context, const MomentsRequest& request,
                                      const VulkanOptions& options);
/// A run for moments by slope samples, which serve all slope distributions: some directions at a time.
std::unique_ptr<Run<Moments>> slope_run(const KernelContext& context, const MomentsRequest& request,
                                        const VulkanOptions& options);
/// A run for pBRDFs. Entries bring their own shapes and need no tables, so the size of a tile bounds the memory.
std::unique_ptr<Run<ScatteringMatrix>> scattering_run(const KernelContext& context, const ScatteringRequest& request,
                                                      const VulkanOptions& options);

KernelVariant mueller_variant(const ScatteringRequest& request);

}  // namespace dolp::vulkan
