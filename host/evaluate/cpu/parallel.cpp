#include "evaluate/cpu/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace dolp {
namespace {

constexpr std::size_t kBlock = 64;  // items between two reports of progress

class Loop {
 public:
  Loop(std::size_t count, const std::function<void(std::size_t)>& body, const Progress& progress)
      : count_(count), body_(body), progress_(progress) {}

  void work() {
    try {
      for (std::size_t first = next_.fetch_add(kBlock); first < count_ && !stop_; first = next_.fetch_add(kBlock)) {
        const std::size_t last = std::min(first + kBlock, count_);
        for (std::size_t i = first; i < last; ++i) body_(i);
        finished(last - first);
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
  void finished(std::size_t items) {
    const std::lock_guard lock(mutex_);
    done_ += items;
    if (progress_ && !progress_(done_, count_)) throw Cancelled{};
  }

  std::size_t count_;
  const std::function<void(std::size_t)>& body_;
  const Progress& progress_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> stop_ = false;
  std::mutex mutex_;
  std::size_t done_ = 0;
  std::exception_ptr error_;
};

}  // namespace

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body, const Progress& progress) {
  Loop loop(count, body, progress);
  std::vector<std::thread> threads;
  const std::size_t useful = (count + kBlock - 1) / kBlock;
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  for (std::size_t i = 1; i < std::min(cores, useful); ++i) threads.emplace_back(&Loop::work, &loop);
  loop.work();
  for (std::thread& thread : threads) thread.join();
  loop.rethrow();
}

}  // namespace dolp
