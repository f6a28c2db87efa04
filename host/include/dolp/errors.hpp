#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>

#define DOLP_EXPORT __attribute__((visibility("default")))

namespace dolp {

/// A scene, points, a table or an argument is wrong (exit status 2 of the command line). The message is one line. It
/// names the file or key, the value and the allowed range.
class DOLP_EXPORT InputError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// No Vulkan device is usable, the device was lost, or this process is a fork of one that uses Vulkan (exit status 3).
class DOLP_EXPORT DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file could not be read or written (exit status 4).
class DOLP_EXPORT IoError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The machine or the device is out of memory (exit status 6).
class DOLP_EXPORT MemoryError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A Progress callback returned false (exit status 130). The message names what remains on disk and how to continue.
class DOLP_EXPORT Cancelled : public std::runtime_error {
 public:
  explicit Cancelled(const std::string& left = "no file was written") : std::runtime_error(left) {}
};

/// A callback that gets the number of finished items. Its first call has done = 0 and comes after all inputs are read.
/// Calls never overlap, but may come from a thread of the library. If the callback returns false, Cancelled is thrown.
using Progress = std::function<bool(std::size_t done, std::size_t total)>;

}  // namespace dolp
