// The Vulkan devices of this machine, and the choice of one.
#pragma once

#include <dolp/device.hpp>
#include <string>
#include <vector>

namespace dolp {

/// Use of the Khronos validation layer, for tests.
enum class ValidationMode {
  kFromEnvironment,  ///< on when the environment variable DOLP_VALIDATION is 1
  kOff,
  kOn,
};

/// Selects a device and its validation mode.
struct DeviceSelector {
  std::string device = {};    ///< name or position, see choose_device
  bool needs_double = false;  ///< double precision in shaders
  ValidationMode validation = ValidationMode::kFromEnvironment;
};

/// All devices in the order of the Vulkan loader; without devices, the reason.
struct DeviceList {
  std::vector<Device> devices;
  std::string why_empty;
};

/// Searches for Vulkan devices. Does not throw if there are none.
DeviceList list_devices();

/// The position of the device that `choice` means. Empty is the default; digits are a position; anything else (and
/// digits beyond the list) is a part of the name, in any case.
/// Among several devices, the choice is the first usable device (with double precision if `float64`) in the order
/// discrete GPU, integrated GPU, virtual GPU, CPU, other.
/// Errors: DeviceError that lists the devices if nothing matches, or names the features that the matching devices lack.
std::size_t choose_device(const std::vector<Device>& devices, const std::string& choice, bool float64);

}  // namespace dolp
