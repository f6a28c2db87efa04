// Measures how accurately a device divides and takes square roots in float. Vulkan allows more than rounding errors.
#pragma once

#include <string>

#include "evaluate/vulkan/command_stream.hpp"
#include "evaluate/vulkan/kernels.hpp"
#include "model/evaluator.hpp"

namespace dolp::vulkan {

/// Computes quotients and square roots of random floats with shaders/arithmetic.comp. It must not be destroyed after a
/// DeviceTimeout.
class ArithmeticProbe {
 public:
  /// `kernels` must be for float.
  ArithmeticProbe(const Device& device, Kernels& kernels);
  /// Compares the results with quotients and square roots in double. Errors: the errors of CommandStream.
  Arithmetic measure(CommandStream& stream, double timeout_s);

 private:
  Kernels& kernels_;
  InputBuffer operands_;
  Buffer results_;
  UniquePipeline pipeline_;
};

/// Errors: DeviceError if errors exceed what Vulkan allows; the message has the error and the name of the device.
void require_allowed(const Arithmetic& measured, const std::string& device);

}  // namespace dolp::vulkan
