// The window as a command.
#pragma once

#include <dolp/dolp.hpp>

#include <cstddef>
#include <string>

namespace dolp::explore {

struct ProgramOptions {
  std::string device;           ///< its position or a part of its name
  std::string command_line;     ///< for the history of tables
  std::string measured_path;    ///< CSV of measured points; empty: none
  std::size_t frames = 0;       ///< draw so many and end; 0: until the window is closed
  std::string screenshot_path;  ///< PNG of the last frame; empty: none
};

/// Shows the window. Prints how long frames took, where their number is given.
/// Errors: those of the public header; DeviceError, IoError.
void run_program(const Scene& scene, const ProgramOptions& options);

}  // namespace dolp::explore
