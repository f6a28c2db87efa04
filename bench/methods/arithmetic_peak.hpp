// Peak float arithmetic rate of a Vulkan device.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace dolp::bench {

/// Measures how many float multiplications and additions per second a kernel does that does nothing else. Returns one
/// value per repeat, in ascending order. Errors: DeviceError.
std::vector<double> arithmetic_peak(const std::string& device, std::size_t repeats);

}  // namespace dolp::bench
