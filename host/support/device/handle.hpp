// Unique ownership of an object that belongs to a VkDevice.
#pragma once

#include <vulkan/vulkan.h>

#include <string>
#include <utility>

#include "device/result.hpp"

namespace dolp::vulkan {

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

/// The object that one of Vulkan's create functions makes; `action` is a gerund phrase. Errors: those of check.
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
