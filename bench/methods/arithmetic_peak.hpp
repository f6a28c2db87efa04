// Peak float arithmetic rate of a Vulkan device.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace dolp::bench {

/// Runs a kernel that only multiplies and adds floats. Returns the operations per second of each repeat, in ascending
/// order. Errors: DeviceError.
std::vector<double> arithmetic_peak(const std::string& device, std::size_t repeats);

}  // namespace dolp::bench
