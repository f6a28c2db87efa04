#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>

#define DOLP_EXPORT __attribute__((visibility("default")))

namespace dolp {

/// A scene, points, a table or an argument is wrong (exit status 2 of the command line). The message is one line with
/// the place, the value and the allowed range.
class DOLP_EXPORT InputError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// No Vulkan device is usable, the device was lost, or this process was forked from one that uses Vulkan (exit 3).
class DOLP_EXPORT DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file could not be read or written (exit 4).
class DOLP_EXPORT IoError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The machine or the device is out of memory (exit 6).
class DOLP_EXPORT MemoryError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A Progress returned false (exit 130). The message names what remains on disk and how to continue.
class DOLP_EXPORT Cancelled : public std::runtime_error {
 public:
  explicit Cancelled(const std::string& left = "no file was written") : std::runtime_error(left) {}
};

/// Receives the number of finished items. The first call has 0 and comes when all inputs are read. Calls come from one
/// thread at a time, which may not be the caller's. If it returns false, the call of the library ends with Cancelled.
using Progress = std::function<bool(std::size_t done, std::size_t total)>;

}  // namespace dolp
