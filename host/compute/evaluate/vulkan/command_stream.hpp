// Records commands, submits them and waits; the buffers that their kernels read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "device/buffer.hpp"
#include "device/device.hpp"
#include "device/result.hpp"

namespace dolp::vulkan {

class Kernels;

/// The accesses that a barrier separates.
enum class Barrier {
  kUploadToKernel,  ///< staging copies, then a kernel that reads them; nothing happens without copies
  kKernelToKernel,  ///< a kernel writes, the next ones read
  kKernelToHost,    ///< kernels write, the host reads after the wait
};

/// One command buffer, recorded and submitted again and again; at most one submission is in flight.
class CommandStream {
 public:
  explicit CommandStream(const Device& device);

  /// Starts recording, and the clock.
  void begin();
  void copy(const Buffer& from, VkBuffer to, VkDeviceSize bytes);
  void barrier(Barrier barrier);
  /// Runs `pipeline` on `count` invocations from `first` (see DOLP_PUSH_CONSTANTS); does nothing if `count` is 0.
  void dispatch(const Kernels& kernels, VkPipeline pipeline, std::uint32_t first, std::uint32_t count,
                int largest_order, std::uint32_t sky = 0);
  /// Submits the recording and waits for it. Returns the seconds from begin to end, measured by the device's clock. If
  /// the queue has no timestamps, the host's clock measures them, with the submission.
  /// Errors: DeviceTimeout after `timeout_s`; DeviceError if the device is lost.
  double submit_and_wait(double timeout_s);

 private:
  double elapsed_s() const;

  const Device& device_;
  UniqueCommandPool pool_;
  UniqueFence fence_;
  UniqueQueryPool timestamps_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  bool has_copies_ = false;  ///< copies were recorded since the last barrier
};

/// A buffer in the device's own memory that the host writes and kernels read. The host writes directly where it can map
/// that memory, and otherwise through a staging buffer.
class InputBuffer {
 public:
  /// `force_staging` uses the staging buffer on every device.
  InputBuffer(const Device& device, VkDeviceSize bytes, bool force_staging, VkFormat texels = VK_FORMAT_UNDEFINED);

  VkBuffer get() const { return buffer_.get(); }
  VkBufferView texels() const { return buffer_.texels(); }
  /// Writes to the start of the buffer; a staging copy is recorded in `stream`, which must be recording.
  void write(std::span<const std::byte> bytes, CommandStream& stream);

 private:
  std::optional<Buffer> staging_;
  Buffer buffer_;
};

}  // namespace dolp::vulkan
