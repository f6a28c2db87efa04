// Runs programs for tests with arguments in a folder. Returns exit status and both outputs.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "temporary_file.hpp"

namespace dolp {

/// An open file. The destructor closes it.
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

/// A command to run. The program is searched on PATH.
struct Command {
  std::vector<std::string> arguments;
  std::filesystem::path folder;
  std::string input = {};
  std::filesystem::path out_path = {};  ///< file for standard output; if given, Outcome::out stays empty
  std::vector<std::pair<std::string, std::string>> environment = {};
};

struct Outcome {
  int status = 0;  ///< the exit status, or minus the number of the signal that ended the program
  std::string out;
  std::string err;
};

/// Runs a program to its end. SIGALRM ends a program that takes longer than a minute.
Outcome run(const Command& command);

/// A running program whose standard error is a terminal. Its standard output is discarded, its input is empty.
class TerminalProcess {
 public:
  explicit TerminalProcess(const Command& command);
  /// Kills the program if it still runs.
  ~TerminalProcess();
  TerminalProcess(const TerminalProcess&) = delete;
  TerminalProcess& operator=(const TerminalProcess&) = delete;

  /// Waits until the program writes to the terminal. Returns false if it ends without output.
  bool wait_for_output();
  void send_signal(int number) const;
  /// Waits for the end. `err` contains everything that the terminal showed.
  Outcome finish();

 private:
  bool read_some();

  Descriptor terminal_;
  pid_t process_;
  std::string shown_;
};

}  // namespace dolp
