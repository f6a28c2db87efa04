// A Vulkan device for kernels that only the benchmark has.
#pragma once

#include <string>

#include "device/context.hpp"
#include "device/device.hpp"
#include "evaluate/vulkan/command_stream.hpp"

namespace dolp::bench {

/// `choice`: position of the device in the list, or part of its name; empty means the default. Errors: DeviceError.
VkPhysicalDevice chosen_device(const vulkan::Instance& instance, const std::string& choice);

/// A Vulkan device with its instance and command stream. If the environment variable DOLP_VALIDATION is 1, the
/// validation layer is on.
struct BenchDevice {
  /// `choice`: as in chosen_device(). Errors: DeviceError.
  explicit BenchDevice(const std::string& choice);
  BenchDevice(const BenchDevice&) = delete;
  BenchDevice& operator=(const BenchDevice&) = delete;

  /// Name and driver of the device.
  std::string where() const;

  /// Checks the messages of the validation layer. Errors: DeviceError if there is a message.
  void check_messages() const;

  vulkan::ValidationLog log;
  vulkan::Instance instance;
  VkPhysicalDevice physical;
  vulkan::Device device;
  vulkan::CommandStream stream;
};

}  // namespace dolp::bench
