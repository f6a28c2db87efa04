#pragma once

#include <dolp/device.hpp>
#include <string>
#include <vector>

namespace dolp {

struct DeviceSelector {
  std::string device = {};    ///< position in the list of devices, part of a name, or empty
  bool needs_double = false;  ///< true if shaders need double precision
  /// Vulkan's validation layer checks all Vulkan calls. It also does so if the environment variable DOLP_VALIDATION
  /// is 1.
  bool has_validation = false;
};

struct DeviceList {
  std::vector<Device> devices;  ///< in the order of the Vulkan loader
  std::string why_empty;        ///< the reason if there are no devices
};

DeviceList list_devices();  ///< does not throw if there are no devices

/// Returns the position of a device in `devices`. `choice` is this position, a part of the device's name in upper or
/// lower case, or empty. If `float64` is true, the device must have double precision. If several devices match, the
/// order of preference is discrete GPU, integrated GPU, virtual GPU, CPU, other. Errors: DeviceError that lists the
/// devices, if no usable device matches.
std::size_t choose_device(const std::vector<Device>& devices, const std::string& choice, bool float64);

}  // namespace dolp
