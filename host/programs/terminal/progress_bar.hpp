#pragma once

#include <chrono>
#include <cstddef>
#include <dolp/errors.hpp>
#include <string>

namespace dolp {

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
