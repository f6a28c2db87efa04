// A Vulkan device for kernels that only the benchmark has.
#pragma once

#include <string>

#include "device/context.hpp"
#include "device/device.hpp"
#include "evaluate/vulkan/command_stream.hpp"

namespace dolp::bench {

/// Instance, device and stream; with the validation layer if DOLP_VALIDATION is 1.
struct BenchDevice {
  /// `choice`: position or part of the name; empty means the default. Errors: DeviceError.
  explicit BenchDevice(const std::string& choice);
  BenchDevice(const BenchDevice&) = delete;
  BenchDevice& operator=(const BenchDevice&) = delete;

  /// Name and driver.
  std::string where() const;

  /// Errors: DeviceError if the validation layer reported a message.
  void check_messages() const;

  vulkan::ValidationLog log;
  vulkan::Instance instance;
  VkPhysicalDevice physical;
  vulkan::Device device;
  vulkan::CommandStream stream;
};

}  // namespace dolp::bench
