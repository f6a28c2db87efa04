#pragma once

#include <vulkan/vulkan.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "device/device.hpp"
#include "device/devices.hpp"

namespace dolp::vulkan {

/// Collects warnings and errors of Vulkan's validation layer. The layer may call add() from any thread.
class ValidationLog {
 public:
  void add(std::string message);
  std::vector<std::string> messages() const;

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> messages_;
};

class Instance {
 public:
  /// If `log` is not null, the Khronos validation layer checks all Vulkan calls and reports to `log`.
  /// Errors: DeviceError without a Vulkan driver, or if the validation layer is needed but not installed.
  explicit Instance(ValidationLog* log);
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;
  ~Instance();

  VkInstance get() const { return instance_; }

  /// All devices, in the order of the Vulkan loader. Errors: DeviceError if there is none.
  std::vector<VkPhysicalDevice> physical_devices() const;

 private:
  void attach(const VkDebugUtilsMessengerCreateInfoEXT& info);

  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};

/// A Vulkan instance with the one device that choose_device() selects.
class Context {
 public:
  /// Errors: DeviceError if no usable device matches `wish`, or if the validation layer is needed but not installed.
  explicit Context(const DeviceSelector& wish);
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const dolp::Device& description() const { return description_; }
  const Device& device() const { return *device_; }

  std::vector<std::string> validation_messages() const { return log_.messages(); }
  /// Errors: DeviceError with the first of the validation_messages(), if there are any.
  void check_validation() const;

 private:
  ValidationLog log_;
  std::unique_ptr<Instance> instance_;
  dolp::Device description_;
  std::unique_ptr<Device> device_;
};

}  // namespace dolp::vulkan
