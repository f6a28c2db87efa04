// Progress on stderr, and the way Ctrl-C ends a run.
#pragma once

#include <chrono>
#include <cstddef>
#include <dolp/errors.hpp>
#include <string>

namespace dolp {

/// A bar with rate and time left, drawn on stderr when that is a terminal and `quiet` is off.
///
/// From the first call of its callback on SIGINT, SIGTERM and SIGHUP only ask the run to stop (base/interrupt.hpp).
/// Before, while inputs are read, they end the program as usual.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Draws, and returns false after an interrupt. Refers to this object, which ends its line when it is destroyed: a
  /// temporary one at the end of the call that it is passed to.
  Progress callback();

  /// Begins again, and counts these, not entries.
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
