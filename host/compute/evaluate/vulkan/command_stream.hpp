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

enum class Barrier {
  kUploadToKernel,  ///< staging copies write, a kernel reads; does nothing if no copies were recorded
  kKernelToKernel,  ///< a kernel writes, the next kernels read
  kKernelToHost,    ///< kernels write, the host reads after the wait
};

/// One command buffer, recorded and submitted again and again. At most one submission is in flight.
class CommandStream {
 public:
  explicit CommandStream(const Device& device);

  void begin();
  void copy(const Buffer& from, VkBuffer to, VkDeviceSize bytes);
  void barrier(Barrier barrier);
  /// Runs `pipeline` on `count` invocations from `first` (see DOLP_PUSH_CONSTANTS); does nothing if `count` is 0.
  void dispatch(const Kernels& kernels, VkPipeline pipeline, std::uint32_t first, std::uint32_t count,
                int largest_order, std::uint32_t sky = 0);
  /// Submits the recording and waits for its end. Returns the duration in seconds by the device's clock. If the queue
  /// has no timestamps, the time is by the host's clock and includes the submission.
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

/// A buffer on the device that the host writes, directly or through a staging buffer, and kernels read.
class InputBuffer {
 public:
  /// The buffer uses staging if `force_staging`, or if the host cannot map the memory of the device.
  InputBuffer(const Device& device, VkDeviceSize bytes, bool force_staging, VkFormat texels = VK_FORMAT_UNDEFINED);

  VkBuffer get() const { return buffer_.get(); }
  VkBufferView texels() const { return buffer_.texels(); }
  /// Writes to the start of the buffer. With staging, it adds a copy command to `stream`, so begin() must come first.
  void write(std::span<const std::byte> bytes, CommandStream& stream);

 private:
  std::optional<Buffer> staging_;
  Buffer buffer_;
};

}  // namespace dolp::vulkan
