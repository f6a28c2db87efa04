// Threads that compute for the window.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "explore/points.hpp"

namespace dolp::explore {

/// Runs `work` on a thread of its own. `result` gets what it returns or throws; then `on_end` is called from there.
template <class Result, class Work>
std::jthread run_in_background(Work work, std::future<Result>& result, const std::function<void()>& on_end) {
  std::packaged_task<Result()> task(std::move(work));
  result = task.get_future();
  return std::jthread([task = std::move(task), on_end]() mutable {
    task();
    on_end();
  });
}

/// True where the work of run_in_background has ended.
template <class Result>
bool is_ended(const std::future<Result>& result) {
  return !result.valid() || result.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

/// One piece of work at a time that the user starts, watches and may cancel. All calls come from the window's thread.
class BackgroundTask {
 public:
  /// The rest of the work, in the window's thread; returns what to tell the user. Throws as Work.
  using Rest = std::function<std::string()>;
  /// Runs on a thread of its own. Throws Cancelled when its Progress returns false.
  using Work = std::function<Rest(const Progress&)>;
  enum class State { kNone, kRunning, kDone, kFailed, kCancelled };

  /// `on_change` is called from the thread, at each progress and at the end.
  explicit BackgroundTask(std::function<void()> on_change) : on_change_(std::move(on_change)) {}
  BackgroundTask(const BackgroundTask&) = delete;
  BackgroundTask& operator=(const BackgroundTask&) = delete;
  /// Cancels and waits.
  ~BackgroundTask() { cancel(); }

  /// Does nothing while one runs.
  void start(const Work& work);
  void cancel() { is_cancelled_ = true; }
  /// Does the rest of work that has ended.
  void finish();

  State state() const { return state_; }
  bool is_running() const { return state_ == State::kRunning; }
  /// From 0 to 1.
  double progress() const { return progress_; }
  /// The phase whose progress it is; empty where work has one phase. The work sets it, and progress begins anew.
  std::string phase() const;
  void set_phase(const std::string& phase);
  /// The message, or the reason of a failure, in one line.
  const std::string& message() const { return message_; }

 private:
  std::function<void()> on_change_;
  std::atomic<bool> is_cancelled_{false};
  std::atomic<double> progress_{0.0};
  mutable std::mutex mutex_;
  std::string phase_;
  State state_ = State::kNone;
  std::string message_;
  std::future<Rest> result_;
  std::jthread thread_;  ///< last: it uses all of the above
};

/// Points of a scene that the window wants, computed as `dolp eval` computes them.
struct Job {
  std::string key;  ///< jobs with one key have one content
  Scene scene;
  /// The units of work, computed one after the other; a job of higher rank may come in between.
  std::vector<PointList> parts;
  double tolerance = 0.0;  ///< instead of the scene's, where that is less
  bool keep_all = false;
  bool wants_effects = false;
  bool is_brief = false;  ///< once begun it is finished, wanted or not
};

/// A part of a job's results.
struct JobPart {
  std::string key = {};
  std::size_t part = 0;  ///< of the job
  Scene scene;           ///< of the job, with its tolerance
  std::vector<Point> points = {};
  std::string csv = {};  ///< of this part with the columns of `dolp eval`, where the job wants effects
  bool is_last = false;
  // Totals of the whole job, in the last part.
  std::vector<Effect> effects = {};
  double wall_s = 0.0;
  double evaluations = 0.0;
};

/// Has the meaning of `evaluate`. Called from one thread.
using Evaluate = std::function<Results(const Scene& scene, const PointList& list, const RunOptions& options)>;

/// Computes the wanted jobs in order; a job that is no longer wanted stops within a tile of the device, unless brief.
class Worker {
 public:
  /// `on_news` is called from the worker's thread after each part and after a failure.
  Worker(Evaluate evaluate, std::function<void()> on_news);
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker();

  /// Replaces the list of wanted jobs, the most wanted first. A running job continues if its key is still in the list.
  void want(std::vector<Job> jobs);

  /// The results since the last call. Errors: rethrows what ended the worker, a DeviceError for instance.
  std::vector<JobPart> take_news();

  /// Waits until there are results to take, at most this long.
  void await_news(std::chrono::duration<double> at_most);

  /// True where all wanted jobs are done; their results may still wait to be taken.
  bool is_idle() const;

 private:
  struct Task {
    Job job;
    std::size_t next = 0;  ///< of its parts
    double wall_s = 0.0;
    double evaluations = 0.0;
  };

  void run();
  /// Waits for one; none at the end.
  std::optional<Task> next_task();
  JobPart advance(Task& task);
  /// Reports the finished part of a task; the rest of it goes back to its rank among the wanted jobs.
  void put_back(Task task, std::optional<JobPart> part);
  bool is_wanted(const std::string& key) const;
  bool goes_on(const Job& job) const;

  Evaluate evaluate_;
  std::function<void()> on_news_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::condition_variable arrived_;
  std::vector<Task> tasks_;  ///< without the one under way
  std::vector<std::string> wanted_;
  std::vector<std::string> finished_;  ///< of those wanted
  std::string running_;                ///< empty when none is
  std::vector<JobPart> news_;
  bool is_stopping_ = false;
  std::future<void> end_;  ///< with what ended the worker before it was told to
  std::jthread thread_;    ///< last: it uses all of the above
};

}  // namespace dolp::explore
