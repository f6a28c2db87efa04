// Runs programs for tests: arguments, folder and environment in; exit status and both outputs out.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "temporary_file.hpp"

namespace dolp {

/// An open file, closed with the object.
class Descriptor {
 public:
  explicit Descriptor(int number);
  ~Descriptor();
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

/// A command to run. The program is looked up on PATH.
struct Command {
  std::vector<std::string> arguments;
  std::filesystem::path folder;
  std::string input = {};
  std::filesystem::path out_path = {};  ///< where standard output goes instead of Outcome::out
  std::vector<std::pair<std::string, std::string>> environment = {};
};

struct Outcome {
  int status = 0;  ///< the exit status, or minus the number of the signal that ended the program
  std::string out;
  std::string err;
};

/// Runs a program to its end. One that takes longer than a minute is ended by SIGALRM.
Outcome run(const Command& command);

/// A running program whose standard error is a terminal; its standard output goes nowhere, its input is empty.
class TerminalProcess {
 public:
  explicit TerminalProcess(const Command& command);
  /// Kills the program if it still runs.
  ~TerminalProcess();
  TerminalProcess(const TerminalProcess&) = delete;
  TerminalProcess& operator=(const TerminalProcess&) = delete;

  /// Waits until the program has written something to the terminal. False if it ended without.
  bool wait_for_output();
  void send_signal(int number) const;
  /// Waits for the end; `err` is all that the terminal showed.
  Outcome finish();

 private:
  bool read_some();

  Descriptor terminal_;
  pid_t process_;
  std::string shown_;
};

}  // namespace dolp
