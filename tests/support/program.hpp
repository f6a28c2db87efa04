// Runs programs for tests and returns their exit status and output.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "temporary_file.hpp"

namespace dolp {

/// A file descriptor that the destructor closes.
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

/// A program with its arguments. If arguments[0] has no slash, PATH is searched for it.
struct Command {
  std::vector<std::string> arguments;
  std::filesystem::path folder;
  std::string input = {};
  std::filesystem::path out_path = {};  ///< file for standard output; if empty, Outcome::out gets standard output
  std::vector<std::pair<std::string, std::string>> environment = {};
};

struct Outcome {
  int status = 0;  ///< exit status, or minus the number of the signal that ended the program
  std::string out;
  std::string err;
};

/// Runs a program to its end. SIGALRM ends a program that takes longer than a minute.
Outcome run(const Command& command);

/// A running program. Its standard error is a terminal; its standard output is discarded; its input is empty.
class TerminalProcess {
 public:
  explicit TerminalProcess(const Command& command);
  /// Kills the program if it still runs.
  ~TerminalProcess();
  TerminalProcess(const TerminalProcess&) = delete;
  TerminalProcess& operator=(const TerminalProcess&) = delete;

  /// Waits until the program writes to the terminal. Returns false if the program ends without writing to it.
  bool wait_for_output();
  void send_signal(int number) const;
  /// Waits until the program ends. Outcome::err contains all text that the terminal received.
  Outcome finish();

 private:
  bool read_some();

  Descriptor terminal_;
  pid_t process_;
  std::string shown_;
};

}  // namespace dolp
