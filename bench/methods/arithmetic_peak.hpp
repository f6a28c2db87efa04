// Peak float arithmetic rate of a Vulkan device.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace dolp::bench {

/// Float multiplications and additions per second in `repeats` runs of a kernel that does nothing else. Sorted, the
/// fastest last. Errors: DeviceError.
std::vector<double> arithmetic_peak(const std::string& device, std::size_t repeats);

}  // namespace dolp::bench
