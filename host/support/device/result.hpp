// VkResult to DeviceError.
#pragma once

#include <vulkan/vulkan.h>

#include <dolp/errors.hpp>
#include <string>

namespace dolp::vulkan {

/// The driver did not finish a submission or a compilation in time, or before the user interrupted it. It still uses
/// what it was given: none of the device's objects may be destroyed.
struct DeviceTimeout : DeviceError {
  explicit DeviceTimeout(const std::string& message);
};

/// True after a DeviceTimeout. The program must end without cleaning up, which would pull the driver from under its
/// threads.
bool driver_is_busy();

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
