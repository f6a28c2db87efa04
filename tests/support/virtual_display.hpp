// An X display in memory, and a function that sends it events of mouse and keyboard.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "program.hpp"

namespace dolp {

/// Starts Xvfb, an X server without a screen, and sets DISPLAY for this process and its children.
class VirtualDisplay {
 public:
  explicit VirtualDisplay(const std::string& size = "1440x900") {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("cannot make a pipe");
    const std::string end = std::to_string(ends[1]);
    const std::string screen = size + "x24";
    process_ = ::fork();
    if (process_ == 0) {
      // -r: held keys do not repeat. A test on a slow machine may hold a key so long that it would repeat.
      ::execlp("Xvfb", "Xvfb", "-r", "-displayfd", end.c_str(), "-screen", "0", screen.c_str(), "-fbdir",
               folder_.path().c_str(), "-noreset", "-nolisten", "tcp", nullptr);
      ::_exit(127);
    }
    ::close(ends[1]);
    std::string number;
    for (char character = 0; ::read(ends[0], &character, 1) == 1 && character != '\n';) number += character;
    ::close(ends[0]);
    if (process_ < 0 || number.empty()) throw std::runtime_error("Xvfb does not start");
    ::setenv("DISPLAY", (':' + number).c_str(), 1);
  }
  ~VirtualDisplay() {
    ::kill(process_, SIGTERM);
    ::waitpid(process_, nullptr, 0);
  }
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

  /// The pixels of a rectangle, row by row, with four bytes for each pixel.
  std::string pixels(std::size_t left, std::size_t top, std::size_t width, std::size_t height) const {
    // XWD format: a header of big-endian numbers, a colour table with 12 bytes per entry, rows of pixels.
    const std::string screen = read_file(folder_.path() / "Xvfb_screen0");
    const auto field = [&](std::size_t position) {
      std::size_t value = 0;
      for (std::size_t i = 0; i < 4; ++i) value = 256 * value + static_cast<unsigned char>(screen.at(4 * position + i));
      return value;
    };
    const std::size_t begin = field(0) + 12 * field(19);
    const std::size_t row = field(12);
    std::string found;
    for (std::size_t y = top; y < top + height; ++y) found += screen.substr(begin + y * row + 4 * left, 4 * width);
    return found;
  }

 private:
  TemporaryFolder folder_;
  pid_t process_ = -1;
};

/// Runs xdotool, which sends events of mouse and keyboard to the display. Returns its output.
inline std::string xdotool(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "xdotool");
  const Outcome outcome = run({.arguments = arguments, .folder = "/"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return outcome.out;
}

}  // namespace dolp
