#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <optional>
#include <span>

#include "device/devices.hpp"

namespace dolp::vulkan {

// Limits of devices on which the program relies, and the values that Vulkan 1.2 guarantees ("Required Limits"):
//
// | limit | guaranteed | how the program keeps to it |
// |---|---|---|
// | maxPerStageDescriptorStorageBuffers | 4 | kStorageCount are needed; describe() calls other devices not usable |
// | maxPerStageDescriptorSampledImages, which limits texel buffers | 16 | kTexelCount |
// | maxPerStageResources | 128 | kStorageCount + kTexelCount |
// | maxBoundDescriptorSets | 4 | one |
// | maxPushConstantsSize | 128 bytes | kPushConstantCount words |
// | maxComputeWorkGroupInvocations, maxComputeWorkGroupSize[0] | 128 | kLocalSize |
// | maxComputeWorkGroupCount[0] | 65,535 | sizes_on() in vulkan/tiles.cpp |
// | maxStorageBufferRange | 2^27 bytes | sizes_on(); TiledRun::add_results() for rule nodes |
// | maxTexelBufferElements | 65,536 | masking tables: sizes_on(); rule nodes: TiledRun::add_results() |
// | maxMemoryAllocationCount | 4,096 | at most 40 buffers, which all requests share |
// | maxMemoryAllocationSize | 2^30 bytes | sizes_on(); a larger table of rule nodes is an error of vkAllocateMemory |
// | timestampValidBits of the queue | 0 | without timestamps the host's clock measures kernels |
// | texel buffers of R32G32_SFLOAT, R32G32B32A32_SFLOAT and R32G32B32A32_UINT | yes | no other formats are used |
// | errors of float | 2.5 ulp in a division, 4.5 ulp in a square root | measured (vulkan/arithmetic.cpp) |
constexpr std::uint32_t kStorageCount = 7;  // storage buffers of each kernel, with binding numbers 0 to 6
constexpr std::uint32_t kTexelCount = 2;    // texel buffers of each kernel, with binding numbers 7 and 8
/// Largest number of invocations in a workgroup of dolp. Every Vulkan device allows at least 128.
constexpr std::uint32_t kLocalSize = 64;

/// Position of the queue family on which the kernels run. Prefers a family without graphics, because kernels on the
/// queue of the desktop would keep other programs from drawing. Empty if no family has compute queues.
std::optional<std::uint32_t> choose_queue_family(std::span<const VkQueueFamilyProperties> families);

/// Properties of a device. If dolp cannot run on the device, dolp::Device::why_not has the reason.
dolp::Device describe(VkPhysicalDevice physical);

enum class MemoryUse {
  kDeviceOnly,  ///< not mapped into the host's memory
  kUpload,      ///< mapped, so that the host can write it
  kReadback,    ///< mapped, so that the host can read it
};

struct MemoryType {
  std::uint32_t index = 0;
  VkMemoryPropertyFlags flags = 0;
};

/// Features that a logical device enables beyond those of Vulkan 1.2. The device must support them.
struct DeviceFeatures {
  bool float64 = false;     ///< double precision in shaders
  bool statistics = false;  ///< VK_KHR_pipeline_executable_properties, and pipelines that keep their statistics
};

/// A logical Vulkan device with one compute queue.
class Device {
 public:
  Device(VkPhysicalDevice physical, DeviceFeatures features);
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  ~Device();

  VkDevice get() const { return device_; }
  VkQueue queue() const { return queue_; }
  std::uint32_t queue_family() const { return queue_family_; }
  const VkPhysicalDeviceLimits& limits() const { return limits_; }
  std::uint32_t local_size() const { return local_size_; }  ///< number of invocations in a workgroup
  const DeviceFeatures& features() const { return features_; }
  std::uint32_t timestamp_bits() const { return timestamp_bits_; }  ///< valid bits of a timestamp; 0: no timestamps

  /// The best memory type for `use`. Bit i of `allowed` allows type i. Errors: DeviceError if no allowed type fits.
  MemoryType memory_type(std::uint32_t allowed, MemoryUse use) const;

 private:
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  DeviceFeatures features_;
  std::uint32_t queue_family_ = 0;
  std::uint32_t timestamp_bits_ = 0;
  std::uint32_t local_size_ = 0;
  VkPhysicalDeviceLimits limits_{};
  VkPhysicalDeviceMemoryProperties memory_{};
};

}  // namespace dolp::vulkan
