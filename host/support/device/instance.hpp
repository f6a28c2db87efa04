// The Vulkan instance, with the validation layer on demand.
#pragma once

#include <vulkan/vulkan.h>

#include <mutex>
#include <string>
#include <vector>

namespace dolp::vulkan {

/// Collects the validation layer's warnings and errors; the layer may call from any thread.
class ValidationLog {
 public:
  void add(std::string message);
  std::vector<std::string> messages() const;

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> messages_;
};

/// A Vulkan 1.2 instance.
class Instance {
 public:
  /// Without `log` there is no validation; with it the Khronos layer reports to it, synchronization included, until
  /// the instance is destroyed. `extensions` are those that a window needs.
  /// Errors: DeviceError without any Vulkan driver, or when the validation layer is wanted and not installed.
  explicit Instance(ValidationLog* log, const std::vector<const char*>& extensions = {});
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;
  ~Instance();

  VkInstance get() const { return instance_; }

  /// All devices, in the order of the loader. Errors: DeviceError when there is none.
  std::vector<VkPhysicalDevice> physical_devices() const;

 private:
  void attach(const VkDebugUtilsMessengerCreateInfoEXT& info);

  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};

}  // namespace dolp::vulkan
