#include "fit/together.hpp"

#include <algorithm>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <iterator>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace dolp::fit {
namespace {

constexpr std::size_t kMostThreads = 64;

/// A barrier: tasks wait here until all running tasks have asked.
class Rendezvous {
 public:
  Rendezvous(Residuals& residuals, std::size_t tasks)
      : residuals_(residuals), running_(tasks), asked_(tasks, nullptr), answers_(tasks) {}

  std::vector<Prediction> ask(std::size_t task, const std::vector<Eigen::VectorXd>& points) {
    std::unique_lock lock(mutex_);
    asked_[task] = &points;
    if (++waiting_ == running_) {
      answer();
    } else {
      answered_.wait(lock, [this, round = round_] { return round_ != round; });
    }
    if (failure_) std::rethrow_exception(failure_);
    return std::move(answers_[task]);
  }

  void leave() {
    const std::lock_guard lock(mutex_);
    if (--running_ > 0 && waiting_ == running_) answer();
  }

 private:
  void answer() {
    std::vector<Eigen::VectorXd> all;
    for (const auto* points : asked_) {
      if (points != nullptr) all.insert(all.end(), points->begin(), points->end());
    }
    try {
      if (!failure_) distribute(residuals_.predict(all));
    } catch (...) {
      failure_ = std::current_exception();
    }
    std::ranges::fill(asked_, nullptr);
    waiting_ = 0;
    ++round_;
    answered_.notify_all();
  }

  void distribute(std::vector<Prediction> predictions) {
    auto next = std::make_move_iterator(predictions.begin());
    for (std::size_t task = 0; task < asked_.size(); ++task) {
      if (asked_[task] == nullptr) continue;
      const auto end = next + static_cast<std::ptrdiff_t>(asked_[task]->size());
      answers_[task].assign(next, end);
      next = end;
    }
  }

  Residuals& residuals_;
  std::mutex mutex_;
  std::condition_variable answered_;
  std::size_t running_;
  std::size_t waiting_ = 0;
  std::uint64_t round_ = 0;
  std::vector<const std::vector<Eigen::VectorXd>*> asked_;  ///< of each task that waits
  std::vector<std::vector<Prediction>> answers_;
  std::exception_ptr failure_;
};

void run_some(Residuals& residuals, std::size_t first, std::size_t count,
              const std::function<void(Residuals&, std::size_t)>& task) {
  Rendezvous rendezvous(residuals, count);
  std::vector<std::exception_ptr> failures(count);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < count; ++i) {
    threads.emplace_back([&, i] {
      Residuals own = residuals.asking([&rendezvous, i](const auto& points) { return rendezvous.ask(i, points); });
      try {
        task(own, first + i);
      } catch (...) {
        failures[i] = std::current_exception();
      }
      rendezvous.leave();
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace

void run_together(Residuals& residuals, std::size_t count, const std::function<void(Residuals&, std::size_t)>& task) {
  for (std::size_t first = 0; first < count; first += kMostThreads) {
    run_some(residuals, first, std::min(kMostThreads, count - first), task);
  }
}

}  // namespace dolp::fit
