#pragma once

#include <dolp/device.hpp>
#include <string>
#include <vector>

namespace dolp {

/// Switches Vulkan's validation layer, which checks all calls, for tests.
enum class ValidationMode {
  kFromEnvironment,  ///< used if the environment variable DOLP_VALIDATION is 1
  kOff,
  kOn,
};

struct DeviceSelector {
  std::string device = {};    ///< the `choice` of choose_device()
  bool needs_double = false;  ///< true if shaders need double precision
  ValidationMode validation = ValidationMode::kFromEnvironment;
};

struct DeviceList {
  std::vector<Device> devices;  ///< in the order of the Vulkan loader
  std::string why_empty;        ///< the reason if there are no devices
};

DeviceList list_devices();  ///< does not throw if there are no devices

/// Returns the position of a device in `devices`. `choice` is a position, a part of the device's name (in any case), or
/// empty. If `float64` is true, the device must have double precision. If several devices match, the order of
/// preference is discrete GPU, integrated GPU, virtual GPU, CPU, other. Errors: DeviceError that lists the devices, if
/// no usable device matches.
std::size_t choose_device(const std::vector<Device>& devices, const std::string& choice, bool float64);

}  // namespace dolp
