// Peak float arithmetic rate of a Vulkan device.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace dolp::bench {

/// Measures the float multiplications and additions per second of a kernel that does nothing else. Returns one value
/// per repeat, in ascending order. Errors: DeviceError.
std::vector<double> arithmetic_peak(const std::string& device, std::size_t repeats);

}  // namespace dolp::bench
