// The exceptions of the program, one per exit status; terminal/guarded.cpp translates them in one place.
#pragma once

#include <stdexcept>
#include <string>

namespace dolp {

/// Usage, scene or input file is wrong (exit 2). The message is one line: file, line, key, value, what is allowed.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// No usable Vulkan device, or the device was lost (exit 3).
struct DeviceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Out of memory, on the device too (exit 6).
struct MemoryError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A file could not be read or written (exit 4).
struct IoError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace dolp
