#pragma once

#include <cstddef>
#include <string>

namespace dolp {

/// Name of this machine's processor as the kernel reports it, or "unknown processor".
const std::string& processor_name();

/// The most memory that this process has had so far.
std::size_t peak_resident_bytes();

}  // namespace dolp
