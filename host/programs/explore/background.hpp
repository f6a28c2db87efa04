#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "explore/points.hpp"

namespace dolp::explore {

/// Starts a thread that calls `work` and then `on_end`. `result` gets the value or the exception of `work`.
template <class Result, class Work>
std::jthread run_in_background(Work work, std::future<Result>& result, const std::function<void()>& on_end) {
  std::packaged_task<Result()> task(std::move(work));
  result = task.get_future();
  return std::jthread([task = std::move(task), on_end]() mutable {
    task();
    on_end();
  });
}

template <class Result>
bool is_ended(const std::future<Result>& result) {  // true also if no work was started
  return !result.valid() || result.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

/// Runs one piece of work at a time on a separate thread. The work may call no function of this object but set_phase().
class BackgroundTask {
 public:
  /// A function that finish() calls after the work, in the window's thread. Returns a message for the user. May throw.
  using Ending = std::function<std::string()>;
  /// Work for a separate thread. It must throw Cancelled if the Progress function returns false.
  using Work = std::function<Ending(const Progress&)>;
  enum class State { kNone, kRunning, kDone, kFailed, kCancelled };

  /// The thread of the work calls `on_change` when progress() changes, and when the work has ended.
  explicit BackgroundTask(std::function<void()> on_change) : on_change_(std::move(on_change)) {}
  ~BackgroundTask() { cancel(); }  ///< waits for the end of the work

  [[nodiscard]] bool start(const Work& work);  ///< returns false and does nothing while other work is running
  void cancel() { is_cancelled_ = true; }
  void finish();  ///< if the work has ended, calls its Ending, and sets state() and message()

  State state() const { return state_; }
  bool is_running() const { return state_ == State::kRunning; }
  double progress() const { return progress_; }  ///< finished share of the current phase, from 0 to 1
  /// Name of the phase that the work announced last, by set_phase(); empty if the work announced no phase.
  std::string phase() const {
    const std::scoped_lock lock(mutex_);
    return phase_;
  }
  void set_phase(const std::string& phase) {
    progress_ = 0.0;
    const std::scoped_lock lock(mutex_);
    phase_ = phase;
  }
  const std::string& message() const { return message_; }  ///< one line; after a failure, the reason

 private:
  std::function<void()> on_change_;
  std::atomic<bool> is_cancelled_{false};
  std::atomic<double> progress_{0.0};
  mutable std::mutex mutex_;
  std::string phase_;
  State state_ = State::kNone;
  std::string message_;
  std::future<Ending> result_;
  std::jthread thread_;  ///< declared last: its destructor waits for the thread before other members disappear
};

/// A request of the window: points of a scene, to be computed as `dolp eval` computes them.
struct Job {
  std::string key;  ///< jobs with the same key have the same content
  Scene scene;
  std::vector<Setting> settings = {};  ///< changes of the scene
  PointList list;
  double tolerance = 0.0;  ///< the job has the larger one of this tolerance and its scene's tolerance
  bool keep_all = false;
  bool wants_effects = false;  ///< the result then has JobResult::effects
  bool is_brief = false;       ///< once begun, the job runs to its end even if it is no longer wanted
};

struct JobResult {
  std::string key = {};
  Scene scene;  ///< Job::scene with the settings and the tolerance that were used for `points`
  PointList list = {};
  Results results = {};
  std::vector<Point> points = {};  ///< the points of `list` with their `results`
  std::string refusal = {};        ///< why no point has a value: slope widths that differ too much; "" if they have
  std::vector<Effect> effects = {};
  double wall_s = 0.0;

  std::string csv() const { return to_csv(list.columns(), results); }  ///< with the columns of `dolp eval`
};

/// Holds the result of one job. While a new job is computed, points() still returns the old points.
class Sweep {
 public:
  /// Sets the job to compute. `column` is the column of the job's PointList that at() returns.
  void follow(Job job, const std::string& column = "theta_deg");
  std::optional<Job> wanted() const { return is_finished() ? std::nullopt : job_; }
  void take(const JobResult& news) {
    if (job_ && news.key == job_->key) shown_ = news;
  }
  bool is_finished() const { return job_ && shown_ && shown_->key == job_->key; }  ///< points() are of the newest job
  std::vector<Point> points() const { return shown_ ? shown_->points : std::vector<Point>(); }
  std::vector<double> at() const {  // values of `column`, one per point
    return shown_ ? PointList(shown_->list)[column_] : std::vector<double>();
  }
  std::string csv() const { return shown_.value().csv(); }

 private:
  std::optional<Job> job_;
  std::string column_;
  std::optional<JobResult> shown_;
};

/// A function that computes points, as Evaluator::evaluate() does. Only the thread of the Worker calls this function.
using Evaluate = std::function<Results(const Scene&, const std::vector<Column>& points, const RunOptions&)>;

/// A thread that computes the jobs of want() in order. When the evaluator reports progress on a job that is no longer
/// wanted, the thread cancels this job, unless Job::is_brief is true.
class Worker {
 public:
  /// The thread of the worker calls `on_news` after each job and after a failure.
  Worker(Evaluate evaluate, std::function<void()> on_news);
  ~Worker();

  /// Replaces the list of wanted jobs, the most urgent first. A running job continues if its key is in the new list.
  void want(std::vector<Job> jobs);

  /// The results since the last call. Errors: the exception that ended the worker.
  std::vector<JobResult> take_news() {
    if (end_.valid() && is_ended(end_)) end_.get();
    const std::scoped_lock lock(mutex_);
    return std::exchange(news_, {});
  }

  void await_news(std::chrono::duration<double> at_most) {
    std::unique_lock lock(mutex_);
    arrived_.wait_for(lock, at_most, [this] { return !news_.empty() || is_ended(end_); });
  }

  /// True if all wanted jobs are computed, or if an error ended the worker. Results may still wait for take_news().
  bool is_idle() const {
    const std::scoped_lock lock(mutex_);
    return (!is_running_ && std::ranges::all_of(tasks_, &Task::is_done)) || is_ended(end_);
  }

 private:
  struct Task {
    Job job;
    bool is_done = false;
  };

  void run();
  JobResult compute(const Job& job);
  Task* find(const std::string& key) {  // null if no wanted task has this key
    const auto found = std::ranges::find(tasks_, key, [](const Task& task) { return task.job.key; });
    return found == tasks_.end() ? nullptr : &*found;
  }
  bool may_continue(const Job& job) {
    const std::scoped_lock lock(mutex_);
    return !is_stopping_ && (job.is_brief || find(job.key));
  }

  Evaluate evaluate_;
  std::function<void()> on_news_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::condition_variable arrived_;
  std::vector<Task> tasks_;  ///< the wanted jobs, the most urgent first
  bool is_running_ = false;
  std::vector<JobResult> news_;
  bool is_stopping_ = false;
  std::future<void> end_;  ///< holds the exception that ended the worker
  std::jthread thread_;    ///< declared last: its destructor waits for the thread before other members disappear
};

}  // namespace dolp::explore
