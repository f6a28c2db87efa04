#include "explore/background_task.hpp"

#include <exception>
#include <utility>

namespace dolp::explore {

BackgroundTask::~BackgroundTask() { cancel(); }

void BackgroundTask::start(Work work) {
  if (state() == State::kRunning) return;
  if (thread_.joinable()) thread_.join();
  is_cancelled_ = false;
  progress_ = 0.0;
  {
    const std::scoped_lock lock(mutex_);
    state_ = State::kRunning;
    message_.clear();
  }
  thread_ = std::jthread([this, work = std::move(work)] { run(work); });
}

void BackgroundTask::run(const Work& work) {
  try {
    const std::string message = work([this](std::size_t done, std::size_t total) {
      progress_ = total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 1.0;
      on_change_();
      return !is_cancelled_;
    });
    end(State::kDone, message);
  } catch (const Cancelled& cancelled) {
    end(State::kCancelled, std::string("cancelled; ") + cancelled.what());
  } catch (const std::exception& error) {
    end(State::kFailed, error.what());
  }
}

void BackgroundTask::end(State state, const std::string& message) {
  {
    const std::scoped_lock lock(mutex_);
    state_ = state;
    message_ = message;
  }
  on_change_();
}

BackgroundTask::State BackgroundTask::state() const {
  const std::scoped_lock lock(mutex_);
  return state_;
}

std::string BackgroundTask::message() const {
  const std::scoped_lock lock(mutex_);
  return message_;
}

}  // namespace dolp::explore
