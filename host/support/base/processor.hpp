#pragma once

#include <cstddef>
#include <string>

namespace dolp {

/// Name of the processor as the kernel reports it, or "unknown processor".
const std::string& processor_name();

/// The largest memory use of this process until now, in bytes.
std::size_t peak_resident_bytes();

}  // namespace dolp
