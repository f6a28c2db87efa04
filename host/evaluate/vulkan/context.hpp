// What evaluators and a window share: instance, device and validation log.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "evaluate/vulkan/device.hpp"
#include "evaluate/vulkan/devices.hpp"
#include "evaluate/vulkan/instance.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"

namespace dolp::vulkan {

/// What a window asks of instance and device.
struct Presentation {
  std::vector<const char*> instance_extensions;
  /// Whether a queue family of a device can show images on the display.
  std::function<bool(VkInstance, VkPhysicalDevice, std::uint32_t family)> can_present;
};

/// A device of an instance, chosen as VulkanOptions say; with `presentation` one that can show a window.
class Context {
 public:
  /// Errors: DeviceError when no usable device matches, it has no double precision and that is wanted, or the
  /// validation layer is wanted and missing.
  explicit Context(const VulkanOptions& options, const Presentation* presentation = nullptr);
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  ~Context();

  const DeviceDescription& description() const { return description_; }
  VkInstance instance() const { return instance_->get(); }
  VkPhysicalDevice physical_device() const { return physical_; }
  const Device& device() const { return *device_; }

  std::vector<std::string> validation_messages() const { return log_.messages(); }
  /// Errors: DeviceError with the first message of the validation layer, if there is one.
  void check_validation() const;

  /// A submission never ended: instance and device are left to the end of the process, because Vulkan forbids
  /// destroying what is in use.
  void abandon() { is_abandoned_ = true; }
  bool is_abandoned() const { return is_abandoned_; }

 private:
  void choose(const VulkanOptions& options, const Presentation* presentation);

  ValidationLog log_;
  std::unique_ptr<Instance> instance_;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  DeviceDescription description_;
  std::unique_ptr<Device> device_;
  bool is_abandoned_ = false;
};

}  // namespace dolp::vulkan
