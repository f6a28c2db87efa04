#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <dolp/errors.hpp>

namespace dolp {

/// A Vulkan device and its limits.
struct Device {
  enum class Type { kDiscrete, kIntegrated, kVirtual, kCpu, kOther };
  std::string name;
  Type type = Type::kOther;
  std::string driver;  ///< name and version of the driver
  std::string api_version;
  bool usable = false;
  std::string why_not;                         ///< why the device is not usable; empty if it is
  bool has_double = false;                     ///< the device supports double precision
  std::uint64_t memory_bytes = 0;              ///< size of the largest heap of device-local memory
  std::uint64_t max_storage_buffer_bytes = 0;  ///< maxStorageBufferRange
  std::uint32_t max_texels = 0;                ///< maxTexelBufferElements
  std::uint32_t max_workgroups = 0;            ///< maxComputeWorkGroupCount[0]
  std::uint32_t subgroup_size = 0;             ///< 0 when unknown (Vulkan 1.0)
  std::uint32_t local_size = 64;               ///< invocations in a workgroup of dolp's kernels
  bool timestamps = false;                     ///< true if the compute queue can write timestamps
};

/// "discrete GPU", "integrated GPU", "virtual GPU", "CPU" or "other".
DOLP_EXPORT std::string type_name(Device::Type type);

/// All devices, in the order of the Vulkan loader. EvaluatorOptions::device may be a position in this list.
DOLP_EXPORT std::vector<Device> devices();

/// Throws if `device` cannot be used or, with an empty `device`, if no device can be used. `device` is a position or a
/// part of a name as in EvaluatorOptions::device. Errors: DeviceError with the reason.
DOLP_EXPORT void require_device(const std::string& device = {});

}  // namespace dolp
