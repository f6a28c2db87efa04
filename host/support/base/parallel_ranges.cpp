#include "base/parallel_ranges.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace dolp {
namespace {

class Loop {
 public:
  Loop(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body)
      : count_(count), grain_(grain), body_(body) {}

  void work() {
    try {
      for (std::size_t first = next_.fetch_add(grain_); first < count_ && !stop_; first = next_.fetch_add(grain_)) {
        body_(first, std::min(first + grain_, count_));
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      stop_ = true;
    }
  }

  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::size_t count_;
  std::size_t grain_;
  const std::function<void(std::size_t, std::size_t)>& body_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> stop_ = false;
  std::mutex mutex_;
  std::exception_ptr error_;
};

}  // namespace

void parallel_ranges(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t first, std::size_t last)>& body) {
  Loop loop(count, grain, body);
  std::vector<std::jthread> threads;
  const std::size_t useful = (count + grain - 1) / grain;
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  try {
    for (std::size_t i = 1; i < std::min(cores, useful); ++i) threads.emplace_back(&Loop::work, &loop);
  } catch (const std::system_error&) {
    // Where memory is short the existing threads do the work.
  }
  loop.work();
  threads.clear();  // waits for them
  loop.rethrow();
}

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body, const Progress& progress,
                  std::size_t grain) {
  std::mutex mutex;
  std::size_t done = 0;
  parallel_ranges(count, grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) body(i);
    const std::lock_guard lock(mutex);
    done += last - first;
    if (progress && !progress(done, count)) throw Cancelled();
  });
}

}  // namespace dolp
