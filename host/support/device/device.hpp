// The logical device: one queue, its limits and its memory.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <optional>

#include "device/devices.hpp"

namespace dolp::vulkan {

/// Number of storage buffers that a kernel binds. Texel buffers follow them.
constexpr std::uint32_t kStorageCount = 7;
constexpr std::uint32_t kTexelCount = 2;
/// Largest number of invocations in a workgroup. Every device allows 128.
constexpr std::uint32_t kLocalSize = 64;

/// Description of a device, including the reason if dolp cannot run on it.
dolp::Device describe(VkPhysicalDevice physical);

/// Use of a buffer by host and device.
enum class MemoryUse {
  kDeviceOnly,  ///< not mapped
  kUpload,      ///< mapped; written by the host
  kReadback,    ///< mapped; read by the host
};

/// A kind of memory to allocate from.
struct MemoryType {
  std::uint32_t index = 0;
  VkMemoryPropertyFlags flags = 0;
};

/// A logical device with a queue that computes.
class Device {
 public:
  /// `float64` enables double precision in shaders, which the device must support.
  Device(VkPhysicalDevice physical, bool float64);
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  ~Device();

  VkDevice get() const { return device_; }
  VkQueue queue() const { return queue_; }
  std::uint32_t queue_family() const { return queue_family_; }
  const VkPhysicalDeviceLimits& limits() const { return limits_; }
  /// Invocations of a workgroup.
  std::uint32_t local_size() const { return local_size_; }
  /// Valid bits of the queue's timestamps; 0: the queue has no timestamps.
  std::uint32_t timestamp_bits() const { return timestamp_bits_; }

  /// The best memory type for a use among the types in `allowed` (a bit mask). Errors: DeviceError if none fits.
  MemoryType memory_type(std::uint32_t allowed, MemoryUse use) const;

 private:
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  std::uint32_t queue_family_ = 0;
  std::uint32_t timestamp_bits_ = 0;
  std::uint32_t local_size_ = 0;
  VkPhysicalDeviceLimits limits_{};
  VkPhysicalDeviceMemoryProperties memory_{};
};

}  // namespace dolp::vulkan
