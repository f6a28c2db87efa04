#pragma once

#include <cstddef>
#include <string>

namespace dolp {

const std::string& processor_name();  ///< name in /proc/cpuinfo, or "unknown processor"
std::size_t peak_resident_bytes();    ///< largest memory use of this process until now

}  // namespace dolp
