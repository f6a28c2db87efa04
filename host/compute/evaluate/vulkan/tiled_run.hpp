// Runs a request on a device, tile by tile. A tile is what one dispatch of a kernel computes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <dolp/errors.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "evaluate/vulkan/command_stream.hpp"
#include "evaluate/vulkan/kernels.hpp"
#include "evaluate/vulkan/packing.hpp"
#include "evaluate/vulkan/tiles.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"

namespace dolp::vulkan {

/// Buffers on the device. They outlive requests, because allocating them can take longer than a small request.
struct DeviceBuffers {
  /// One set per slot of the command stream. Inputs that all tiles of a request read are in slot 0.
  std::array<std::array<std::optional<InputBuffer>, kStorageCount + kTexelCount>, kMostInFlight> inputs;
  std::array<std::optional<Buffer>, kMostInFlight> results;
  std::optional<Buffer> masking;
};

struct KernelContext {
  const Device& device;
  const dolp::Device& description;
  Kernels& kernels;
  CommandStream& stream;
  DeviceBuffers& buffers;
  double unit_roundoff = 0.0;  ///< for the error bounds of moments_from_kernel()
  bool staged_uploads = false;
  double tile_timeout_s = 0.0;
};

/// Base class of the runs, which compute one request each. For each tile, a run uploads inputs and submits the kernel.
/// Then it uses the results of the tile before, while the device computes.
class TiledRun {
 public:
  virtual ~TiledRun() = default;
  /// Creates the pipelines before the computation, so that the time for them is measured separately.
  virtual void create_pipelines() { context_.kernels.pipeline(variant_); }
  /// Returns one result per entry of the request. Errors: DeviceError; Cancelled if `progress` returns false. After an
  /// error the device may still use the buffers.
  virtual std::vector<Moments> compute(const Progress& progress) = 0;
  const Work& cost() const { return cost_; }
  std::uint32_t tile_invocations() const { return pace_.invocations(); }

 protected:
  /// Uses the results of a tile, which are in scratch_.
  using UseResults = std::function<void()>;

  /// A submission in flight, and the work that follows its end.
  struct Pending {
    TilePace* pace = nullptr;  ///< learns the time of the submission
    std::size_t invocations = 0;
    std::size_t result_bytes = 0;
    UseResults use = {};  ///< empty if the submission has no results
  };

  TiledRun(const KernelContext& context, const VulkanOptions& options, Precision precision)
      : context_(context),
        packing_(precision == Precision::kDouble),
        pace_(options.tile_s, options.first_tile_invocations, options.max_tile_invocations) {}

  /// Adds a buffer for an input that all tiles read, or a buffer per tile in flight.
  void add_shared_input(std::uint32_t binding, std::size_t bytes, VkFormat texels = VK_FORMAT_UNDEFINED);
  void add_tile_input(std::uint32_t binding, std::size_t bytes);
  template <class Node>
  void add_tile_inputs(std::uint32_t binding, std::size_t count) {
    add_tile_input(binding, count * packing_.node_bytes<Node>());
  }
  void add_masking_tables(std::size_t shapes);
  /// Adds the buffers of the results of a tile and of the rule. All other buffers must be there.
  void add_results(std::uint32_t binding, std::size_t bytes, const KernelData& data, const KernelVariant& variant);
  template <class NodeOf>
  void upload(std::uint32_t binding, std::size_t count, const NodeOf& make_node) {
    packing_.pack(count, make_node, scratch_);
    upload_bytes(binding, scratch_);
  }
  void upload_bytes(std::uint32_t binding, std::span<const std::byte> bytes) {
    inputs_[context_.stream.slot()][binding]->write(bytes, context_.stream);
  }
  void upload_rule(const KernelData& data);

  /// Starts a recording. If all slots are in flight, first waits for a tile and uses its results.
  void begin_tile();
  /// Submits the recording with the kernel on `invocations`. After its end, calls `use` with the results in scratch_.
  void submit_tile(std::size_t invocations, std::size_t result_bytes, const KernelData& data, UseResults use);
  void submit(Pending pending);
  /// Waits for the end of all tiles, and uses their results.
  void finish_tiles();
  /// Calls `progress` with the number of finished entries, `share` times `wanted`. Errors: Cancelled.
  static void note_progress(const Progress& progress, double share, std::size_t wanted);

  KernelContext context_;
  Packing packing_;
  TilePace pace_;  ///< derived classes replace it by one that knows the largest tile
  KernelVariant variant_;
  std::vector<std::byte> scratch_;
  Work cost_;

 private:
  void bind_input(std::size_t slot, std::uint32_t binding, InputBuffer& buffer);
  Buffer& kept_buffer(std::optional<Buffer>& kept, std::size_t bytes, MemoryUse use, VkFormat texels) const;
  InputBuffer& kept_input(std::size_t slot, std::uint32_t binding, std::size_t bytes, VkFormat texels);
  void finish_tile();

  std::array<Kernels::Bindings, kMostInFlight> bindings_;
  std::array<std::array<InputBuffer*, kStorageCount + kTexelCount>, kMostInFlight> inputs_{};
  std::array<Pending, kMostInFlight> pending_;
  std::size_t texel_nodes_ = 0;  ///< rule nodes in the texel buffer; if some do not fit, a storage buffer has all
};

std::unique_ptr<TiledRun> row_run(const KernelContext& context, const MomentsRequest& request,
                                  const VulkanOptions& options);
std::unique_ptr<TiledRun> slope_run(const KernelContext& context, const MomentsRequest& request,
                                    const VulkanOptions& options);

}  // namespace dolp::vulkan
