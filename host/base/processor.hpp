#pragma once

#include <string>

namespace dolp {

/// Name of this machine's processor as the kernel reports it, or "unknown processor".
const std::string& processor_name();

}  // namespace dolp
