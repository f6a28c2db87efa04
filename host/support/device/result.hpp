// VkResult to DeviceError.
#pragma once

#include <vulkan/vulkan.h>

#include <dolp/errors.hpp>
#include <string>

namespace dolp::vulkan {

/// A submission did not finish in time. Its command buffer and buffers are still in use: they must not be destroyed.
struct DeviceTimeout : DeviceError {
  using DeviceError::DeviceError;
};

/// The device is of no more use; another one, even of the same hardware, may be.
struct DeviceLost : DeviceError {
  using DeviceError::DeviceError;
};

/// The name of a result, e.g. "VK_ERROR_DEVICE_LOST".
std::string result_name(VkResult result);

/// True if the process has too little address space left for a driver.
bool lacks_addresses();

/// True if the process may not start the threads that a driver waits for.
bool lacks_threads();

/// Throws unless `result` is VK_SUCCESS; `action` is a gerund phrase.
///
/// Errors: DeviceLost; MemoryError when the device or its driver is out of memory; else DeviceError
/// "Vulkan: ACTION failed: RESULT".
void check(VkResult result, const std::string& action);

}  // namespace dolp::vulkan
