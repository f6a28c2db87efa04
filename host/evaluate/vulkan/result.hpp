// VkResult to DeviceError.
#pragma once

#include <vulkan/vulkan.h>

#include <string>

#include "base/error.hpp"

namespace dolp::vulkan {

/// A submission did not finish in time. Its command buffer and buffers are still in use: they must not be destroyed.
struct DeviceTimeout : DeviceError {
  using DeviceError::DeviceError;
};

/// The name of a result, e.g. "VK_ERROR_DEVICE_LOST".
std::string result_name(VkResult result);

/// Throws DeviceError "Vulkan: ACTION failed: RESULT" unless `result` is VK_SUCCESS; `action` is a gerund phrase.
void check(VkResult result, const char* action);

}  // namespace dolp::vulkan
