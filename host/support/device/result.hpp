#pragma once

#include <vulkan/vulkan.h>

#include <dolp/errors.hpp>
#include <string>
#include <utility>

namespace dolp::vulkan {

/// The driver did not finish a computation or compilation in time, or the user interrupted the waiting. The driver may
/// still use Vulkan objects of the device, so the program must not destroy them.
struct DeviceTimeout : DeviceError {
  explicit DeviceTimeout(const std::string& message);
};

/// True after a DeviceTimeout. The program must then end without destructors, because threads of the driver still run.
bool driver_is_busy();

/// The device became unusable. A new logical device may work, even on the same hardware.
struct DeviceLost : DeviceError {
  using DeviceError::DeviceError;
};

std::string result_name(VkResult result);  ///< for example "VK_ERROR_DEVICE_LOST"
bool lacks_addresses();                    ///< true if too little address space is left for a driver
bool lacks_threads();                      ///< true if the system allows fewer threads than a driver needs

/// Throws unless `result` is VK_SUCCESS. `action` is a phrase such as "creating a buffer". Errors: DeviceLost;
/// MemoryError if the device or its driver is out of memory; otherwise DeviceError "Vulkan: ACTION failed: RESULT".
void check(VkResult result, const std::string& action);

/// Owns `object` and destroys it with `kDestroy(device, object, nullptr)`.
template <class T, auto kDestroy>
class Handle {
 public:
  Handle() = default;
  Handle(VkDevice device, T object) : device_(device), object_(object) {}
  Handle(Handle&& other) noexcept : device_(other.device_), object_(std::exchange(other.object_, VK_NULL_HANDLE)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(object_, other.object_);
    return *this;
  }
  ~Handle() {
    if (object_ != VK_NULL_HANDLE) kDestroy(device_, object_, nullptr);
  }
  T get() const { return object_; }

 private:
  VkDevice device_ = VK_NULL_HANDLE;
  T object_ = VK_NULL_HANDLE;
};

/// Calls `create`, a function such as vkCreateBuffer. Returns the owner of the new object. Errors: as check().
template <class Owner, class Info, class T>
Owner created(VkDevice device, VkResult (*create)(VkDevice, const Info*, const VkAllocationCallbacks*, T*),
              const Info& info, const std::string& action) {
  T object = VK_NULL_HANDLE;
  check(create(device, &info, nullptr, &object), action);
  return Owner(device, object);
}

using UniqueBuffer = Handle<VkBuffer, vkDestroyBuffer>;
using UniqueBufferView = Handle<VkBufferView, vkDestroyBufferView>;
using UniqueMemory = Handle<VkDeviceMemory, vkFreeMemory>;
using UniqueCommandPool = Handle<VkCommandPool, vkDestroyCommandPool>;
using UniqueFence = Handle<VkFence, vkDestroyFence>;
using UniqueQueryPool = Handle<VkQueryPool, vkDestroyQueryPool>;
using UniqueShaderModule = Handle<VkShaderModule, vkDestroyShaderModule>;
using UniquePipeline = Handle<VkPipeline, vkDestroyPipeline>;
using UniquePipelineLayout = Handle<VkPipelineLayout, vkDestroyPipelineLayout>;
using UniqueDescriptorSetLayout = Handle<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout>;
using UniqueDescriptorPool = Handle<VkDescriptorPool, vkDestroyDescriptorPool>;

}  // namespace dolp::vulkan
