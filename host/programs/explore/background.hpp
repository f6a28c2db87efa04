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
  std::vector<PointList> parts;  ///< lists of points, computed one after the other; more urgent jobs may run in between
  double tolerance = 0.0;        ///< the job has the larger one of this tolerance and its scene's tolerance
  bool keep_all = false;
  bool wants_effects = false;  ///< the last part of the job then has JobPart::effects
  bool is_brief = false;       ///< once begun, the job runs to its end even if it is no longer wanted
};

struct JobPart {
  std::string key = {};
  std::size_t part = 0;  ///< position in Job::parts
  Scene scene;           ///< Job::scene with the tolerance that was used for `points`
  std::vector<Point> points = {};
  std::string csv = {};      ///< `points` as CSV with the columns of `dolp eval`; empty if the job has several parts
  std::string refusal = {};  ///< why no point has a value: slope widths that differ too much; "" if they have
  bool is_last = false;
  // The members below belong to the whole job. Only the last part of a job has them.
  std::vector<Effect> effects = {};
  double wall_s = 0.0;
  double evaluations = 0.0;
  std::string device = {};  ///< name and driver of the device; empty unless Job::wants_effects
};

/// Holds the points of one job, which has one part. While a new job is computed, points() still returns the old points.
class Sweep {
 public:
  /// Sets the job to compute. `column` is the column of the job's PointList that at() returns.
  void follow(Job job, const std::string& column = "theta_deg");
  std::optional<Job> wanted() const { return is_finished() ? std::nullopt : job_; }
  bool take(const JobPart& news);
  bool is_finished() const { return job_ && shown_key_ == job_->key; }  ///< points() belong to the newest job
  const std::vector<Point>& points() const { return points_; }
  const std::vector<double>& at() const { return at_; }  ///< values of `column`, one per point
  const std::string& csv() const { return csv_; }        ///< JobPart::csv of points()

 private:
  std::optional<Job> job_;
  std::string column_, shown_key_, csv_;
  std::vector<Point> points_;
  std::vector<double> at_;
};

/// A function that computes points, such as explore::evaluate(). Only the thread of the Worker calls this function.
using Evaluate = std::function<Results(const Scene& scene, const PointList& list, const RunOptions& options)>;

/// A thread that computes the jobs of want() in order. When the evaluator reports progress on a job that is no longer
/// wanted, the thread cancels this job, unless Job::is_brief is true.
class Worker {
 public:
  /// The thread of the worker calls `on_news` after each part of a job and after a failure.
  Worker(Evaluate evaluate, std::function<void()> on_news);
  ~Worker();

  /// Replaces the list of wanted jobs, the most urgent first. A running job continues if its key is in the new list.
  void want(std::vector<Job> jobs);

  /// The parts of jobs that were computed since the last call. Errors: the exception that ended the worker.
  std::vector<JobPart> take_news() {
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
    std::size_t next_part = 0;
    double wall_s = 0.0;       ///< total of the finished parts
    double evaluations = 0.0;  ///< total of the finished parts

    bool is_done() const { return next_part == job.parts.size(); }
  };

  void run();
  JobPart advance(Task& task);
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
  std::vector<JobPart> news_;
  bool is_stopping_ = false;
  std::future<void> end_;  ///< holds the exception that ended the worker
  std::jthread thread_;    ///< declared last: its destructor waits for the thread before other members disappear
};

}  // namespace dolp::explore
