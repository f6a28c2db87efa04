#pragma once

#include <dolp/device.hpp>
#include <string>
#include <vector>

namespace dolp {

/// Whether the Khronos validation layer is used, for tests.
enum class ValidationMode {
  kFromEnvironment,  ///< used if the environment variable DOLP_VALIDATION is 1
  kOff,
  kOn,
};

struct DeviceSelector {
  std::string device = {};    ///< part of a name, or position; see choose_device
  bool needs_double = false;  ///< true if shaders need double precision
  ValidationMode validation = ValidationMode::kFromEnvironment;
};

struct DeviceList {
  std::vector<Device> devices;  ///< in the order of the Vulkan loader
  std::string why_empty;        ///< the reason if there are no devices
};

DeviceList list_devices();  ///< does not throw if there are no devices

/// The position in `devices` of the device that `choice` means. A number in the list is a position. Any other text is a
/// part of a name, where case does not matter. An empty text matches all devices.
/// If several devices match, chooses the first usable one (with double precision if `float64`) in the order discrete
/// GPU, integrated GPU, virtual GPU, CPU, other.
/// Errors: DeviceError that lists the devices if nothing matches, or names the features that the matching devices lack.
std::size_t choose_device(const std::vector<Device>& devices, const std::string& choice, bool float64);

}  // namespace dolp
