// Records commands, submits them and waits.
#pragma once

#include <cstdint>

#include "device/device.hpp"
#include "device/handle.hpp"

namespace dolp::vulkan {

class Buffer;
class Kernels;

/// The accesses that a barrier separates.
enum class Barrier {
  kUploadToKernel,  ///< staging copies, then kernels read; without copies there is nothing to wait for
  kKernelToKernel,  ///< a kernel writes, the next ones read
  kKernelToHost,    ///< kernels write, the host reads after the wait
};

/// One command buffer, recorded and submitted again and again; never more than one submission is in flight.
class CommandStream {
 public:
  explicit CommandStream(const Device& device);

  /// Starts recording, and the clock.
  void begin();
  void copy(const Buffer& from, VkBuffer to, VkDeviceSize bytes);
  void barrier(Barrier barrier);
  /// Runs `pipeline` on `count` invocations from `first` (see DOLP_PUSH_CONSTANTS); does nothing when count is 0.
  void dispatch(const Kernels& kernels, VkPipeline pipeline, std::uint32_t first, std::uint32_t count,
                int largest_order, std::uint32_t sky = 0);
  /// Submits what was recorded and waits for it. Returns the seconds on the device's clock from begin to end; by the
  /// host's clock, submission included, where the queue has no timestamps.
  /// Errors: DeviceTimeout after `timeout_s`; DeviceError when the device is lost.
  double submit_and_wait(double timeout_s);

 private:
  void create_timestamps();
  double elapsed_s() const;

  const Device& device_;
  UniqueCommandPool pool_;
  UniqueFence fence_;
  UniqueQueryPool timestamps_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  bool has_copies_ = false;  ///< since the last barrier
};

}  // namespace dolp::vulkan
