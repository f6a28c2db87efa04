// One piece of work at a time that the user starts, watches and may cancel.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "explore/library.hpp"

namespace dolp::explore {

/// Runs a function on a thread of its own.
class BackgroundTask {
 public:
  /// Returns what to tell the user. Throws Cancelled when its Progress returns false.
  using Work = std::function<std::string(const Progress&)>;
  enum class State { kNone, kRunning, kDone, kFailed, kCancelled };

  /// `on_change` is called from the thread.
  explicit BackgroundTask(std::function<void()> on_change) : on_change_(std::move(on_change)) {}
  BackgroundTask(const BackgroundTask&) = delete;
  BackgroundTask& operator=(const BackgroundTask&) = delete;
  /// Cancels and waits.
  ~BackgroundTask();

  /// Does nothing while one runs.
  void start(Work work);
  void cancel() { is_cancelled_ = true; }

  State state() const;
  /// From 0 to 1.
  double progress() const { return progress_; }
  /// The message that the work returned, or the reason why it failed, in one line.
  std::string message() const;

 private:
  void run(const Work& work);
  void end(State state, const std::string& message);

  std::function<void()> on_change_;
  std::atomic<bool> is_cancelled_{false};
  std::atomic<double> progress_{0.0};
  mutable std::mutex mutex_;
  State state_ = State::kNone;
  std::string message_;
  std::jthread thread_;  ///< last: it uses all of the above
};

}  // namespace dolp::explore
