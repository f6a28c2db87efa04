// Exit statuses, messages and progress of programs.
#pragma once

#include <chrono>
#include <cstddef>
#include <dolp/errors.hpp>
#include <functional>
#include <string>
#include <vector>

namespace dolp {

inline constexpr int kExitDone = 0;
inline constexpr int kExitAccuracy = 1;
inline constexpr int kExitInput = 2;
inline constexpr int kExitDevice = 3;
inline constexpr int kExitIo = 4;
inline constexpr int kExitInternal = 5;
inline constexpr int kExitMemory = 6;
inline constexpr int kExitInterrupted = 130;

/// Prints "PROGRAM: MESSAGE" as one line on stderr. Returns `status`.
int fail(const std::string& program, int status, const std::string& message);

void warn(const std::string& program, const std::vector<std::string>& remarks);

/// Prints "out of memory" on stderr without allocating memory. Returns kExitMemory.
int fail_out_of_memory(const char* program) noexcept;

/// Returns the result of `body`. If `body` throws an error, prints one line and returns the exit status for this error.
int guarded(const std::string& program, const std::function<int()>& body);

/// Draws a bar with rate and remaining time on stderr, if stderr is a terminal and `quiet` is false.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Returns a function that draws the bar. From its first call on, a signal such as Ctrl+C does not end the program;
  /// instead, the function returns false. The ProgressBar must outlive the function.
  Progress callback();

  /// Restarts the time measurement. From now on the bar counts `what`, a plural, instead of "entries".
  void count(const std::string& what);

 private:
  void draw(std::size_t done, std::size_t total);

  using Clock = std::chrono::steady_clock;
  bool visible_;
  bool drawn_ = false;
  bool watches_ = false;
  std::string what_ = "entries";
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_drawn_;
};

}  // namespace dolp
