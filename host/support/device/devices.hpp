// The Vulkan devices of this machine, and which of them is used.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace dolp {

/// One Vulkan device and what it offers.
struct DeviceDescription {
  enum class Type { kDiscrete, kIntegrated, kVirtual, kCpu, kOther };
  std::string name;
  Type type = Type::kOther;
  std::string driver;  ///< name and version
  std::string api_version;
  bool usable = false;
  std::string why_not;                         ///< empty when usable
  bool float64 = false;                        ///< double precision in shaders
  std::uint64_t max_storage_buffer_bytes = 0;  ///< maxStorageBufferRange
  std::uint32_t max_workgroups = 0;            ///< maxComputeWorkGroupCount[0]
  std::uint64_t heap_bytes = 0;                ///< the largest heap of the device's own memory
  std::uint32_t subgroup_size = 0;             ///< 0 when unknown (Vulkan 1.0)
  std::uint32_t local_size = 64;               ///< invocations of a workgroup, as dolp wants them
  bool timestamps = false;                     ///< the compute queue has a clock
};

/// The Khronos validation layer, for tests.
enum class ValidationMode {
  kFromEnvironment,  ///< on when the environment variable DOLP_VALIDATION is 1
  kOff,
  kOn,
};

/// Which device is wanted, and how it is watched.
struct DeviceWish {
  std::string device = {};    ///< name or position, see choose_device
  bool needs_double = false;  ///< double precision in shaders
  ValidationMode validation = ValidationMode::kFromEnvironment;
};

/// "discrete GPU", "integrated GPU", "virtual GPU", "CPU" or "other".
std::string type_name(DeviceDescription::Type type);

/// All devices in the order of the Vulkan loader; without any, the reason.
struct DeviceList {
  std::vector<DeviceDescription> devices;
  std::string why_empty;
};

/// Looks for Vulkan devices; never throws for the lack of them.
DeviceList list_devices();

/// The position of the device that `choice` means: empty is the default, digits are a position, anything else (and
/// digits beyond the list) is a part of the name, in any case.
/// The default is the first usable one (with double precision if `float64`) in the order discrete GPU, integrated GPU,
/// virtual GPU, CPU, other; so is the pick among several devices that match a name.
/// Errors: DeviceError that lists the devices when nothing matches, or says what the matching ones lack.
std::size_t choose_device(const std::vector<DeviceDescription>& devices, const std::string& choice, bool float64);

}  // namespace dolp
