#pragma once

#include <array>
#include <chrono>
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

/// Submissions that the device may have at a time. While it computes one, the host sums the results of the one before.
inline constexpr std::size_t kMostInFlight = 2;

/// Records and submits commands. At most kMostInFlight submissions are in flight. Each recording has a slot, a number
/// below kMostInFlight, for buffers and a descriptor set that no other submission in flight uses.
class CommandStream {
 public:
  explicit CommandStream(const Device& device);

  /// Starts a recording, in slot 0 if no submission is in flight. Fewer than kMostInFlight may be in flight.
  void begin();
  void copy(const Buffer& from, VkBuffer to, VkDeviceSize bytes);
  void barrier(Barrier barrier);
  /// Runs `pipeline` on `count` invocations from `first` (see DOLP_PUSH_CONSTANTS); does nothing if `count` is 0.
  void dispatch(const Kernels& kernels, VkPipeline pipeline, std::uint32_t first, std::uint32_t count,
                int largest_order, std::uint32_t sky = 0);
  void submit();
  /// Waits for the end of the oldest submission in flight. Returns the seconds in which the device worked for it and
  /// for no older submission, by the device's clock. If the queue has no timestamps, the time is by the host's clock
  /// and includes the submission.
  /// Errors: DeviceTimeout after `timeout_s`; DeviceError if the device is lost.
  double wait(double timeout_s);
  double submit_and_wait(double timeout_s) {
    submit();
    return wait(timeout_s);
  }
  /// Waits for the end of all submissions, even if the device is lost. Errors: DeviceTimeout.
  void drain(double timeout_s);

  std::size_t slot() const { return slot_; }  ///< of the recording, or of the next recording
  std::size_t oldest_slot() const { return (slot_ + kMostInFlight - in_flight_) % kMostInFlight; }
  std::size_t in_flight() const { return in_flight_; }

 private:
  struct Recording {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    UniqueFence fence;
    UniqueQueryPool timestamps;
    bool follows = false;  ///< was submitted when another submission was in flight
    std::chrono::steady_clock::time_point submitted;
  };

  VkCommandBuffer commands() const { return recordings_[slot_].commands; }
  double elapsed_s(const Recording& recording);

  const Device& device_;
  UniqueCommandPool pool_;
  std::array<Recording, kMostInFlight> recordings_;
  std::size_t slot_ = 0;
  std::size_t in_flight_ = 0;
  std::uint64_t last_end_ = 0;                           ///< timestamp at the end of the last submission
  std::chrono::steady_clock::time_point last_end_seen_;  ///< when the host saw this end
  bool has_copies_ = false;                              ///< copies were recorded since the last barrier
};

/// A buffer on the device that the host writes, directly or through a staging buffer, and kernels read.
class InputBuffer {
 public:
  /// The buffer uses staging if `force_staging`, or if the host cannot map the memory of the device.
  InputBuffer(const Device& device, VkDeviceSize bytes, bool force_staging, VkFormat texels = VK_FORMAT_UNDEFINED);

  VkBuffer get() const { return buffer_.get(); }
  VkBufferView texels() const { return buffer_.texels(); }
  bool fits(VkDeviceSize bytes, VkFormat texels) const { return buffer_.fits(bytes, texels); }
  /// Writes to the start of the buffer. With staging, it adds a copy command to `stream`, so begin() must come first.
  void write(std::span<const std::byte> bytes, CommandStream& stream);

 private:
  std::optional<Buffer> staging_;
  Buffer buffer_;
};

}  // namespace dolp::vulkan
