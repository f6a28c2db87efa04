// A display without a screen, and hands for mouse and keyboard.
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

/// Xvfb on a display number of its own; DISPLAY of this process and its children points there.
class VirtualDisplay {
 public:
  VirtualDisplay() {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("cannot make a pipe");
    process_ = ::fork();
    if (process_ == 0) {
      const std::string number = std::to_string(ends[1]);
      ::execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "1440x900x24", "-nolisten", "tcp",
               nullptr);
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

 private:
  pid_t process_ = -1;
};

/// Real events of the display, from the X server.
inline std::string xdotool(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "xdotool");
  const Outcome outcome = run({.arguments = arguments, .folder = "/"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return outcome.out;
}

}  // namespace dolp
