#include "explore/background.hpp"

#include <algorithm>
#include <exception>

#include "base/stopwatch.hpp"

namespace dolp::explore {

void BackgroundTask::start(const Work& work) {
  if (is_running()) return;
  is_cancelled_ = false;
  message_.clear();
  set_phase("");
  state_ = State::kRunning;
  const auto with_progress = [this, work] {
    return work([this](std::size_t done, std::size_t total) {
      progress_ = total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 1.0;
      on_change_();
      return !is_cancelled_;
    });
  };
  thread_ = run_in_background(with_progress, result_, on_change_);
}

void BackgroundTask::set_phase(const std::string& phase) {
  progress_ = 0.0;
  const std::scoped_lock lock(mutex_);
  phase_ = phase;
}

std::string BackgroundTask::phase() const {
  const std::scoped_lock lock(mutex_);
  return phase_;
}

void BackgroundTask::finish() {
  if (!is_running() || !is_ended(result_)) return;
  try {
    message_ = result_.get()();
    state_ = State::kDone;
  } catch (const Cancelled& cancelled) {
    const std::string left = cancelled.what();
    message_ = left == Cancelled().what() ? "cancelled" : "cancelled; " + left;
    state_ = State::kCancelled;
  } catch (const std::exception& error) {
    message_ = error.what();
    state_ = State::kFailed;
  }
}

void Sweep::follow(Job job, const std::string& column) {
  job_ = std::move(job);
  column_ = column;
}

bool Sweep::take(const JobPart& news) {
  if (!job_ || news.key != job_->key) return false;
  shown_key_ = news.key;
  points_ = news.points;
  at_ = job_->parts.front()[column_];
  return true;
}

Worker::Worker(Evaluate evaluate, std::function<void()> on_news)
    : evaluate_(std::move(evaluate)),
      on_news_(std::move(on_news)),
      thread_(run_in_background([this] { run(); }, end_, on_news_)) {}

Worker::~Worker() {
  {
    const std::scoped_lock lock(mutex_);
    is_stopping_ = true;
    wanted_.clear();
  }
  changed_.notify_all();
}

void Worker::want(std::vector<Job> jobs) {
  {
    const std::scoped_lock lock(mutex_);
    std::vector<Task> old = std::exchange(tasks_, {});
    wanted_.clear();
    for (Job& job : jobs) {
      wanted_.push_back(job.key);
      if (job.key == running_ || std::ranges::count(finished_, job.key) > 0) continue;
      const auto same = std::ranges::find_if(old, [&](const Task& task) { return task.job.key == job.key; });
      if (same != old.end()) {
        tasks_.push_back(std::move(*same));
        same->job.key.clear();
      } else {
        tasks_.push_back({.job = std::move(job)});
      }
    }
    std::erase_if(finished_, [&](const std::string& key) { return !is_wanted(key); });
  }
  changed_.notify_all();
}

std::vector<JobPart> Worker::take_news() {
  if (end_.valid() && is_ended(end_)) end_.get();
  const std::scoped_lock lock(mutex_);
  return std::exchange(news_, {});
}

void Worker::await_news(std::chrono::duration<double> at_most) {
  std::unique_lock lock(mutex_);
  arrived_.wait_for(lock, at_most, [this] { return !news_.empty() || is_ended(end_); });
}

bool Worker::is_idle() const {
  const std::scoped_lock lock(mutex_);
  return (tasks_.empty() && running_.empty()) || is_ended(end_);
}

bool Worker::is_wanted(const std::string& key) const { return std::ranges::count(wanted_, key) > 0; }

bool Worker::may_continue(const Job& job) const {
  const std::scoped_lock lock(mutex_);
  return !is_stopping_ && (job.is_brief || is_wanted(job.key));
}

std::optional<Worker::Task> Worker::next_task() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return is_stopping_ || !tasks_.empty(); });
  if (is_stopping_) return std::nullopt;
  Task task = std::move(tasks_.front());
  tasks_.erase(tasks_.begin());
  running_ = task.job.key;
  return task;
}

void Worker::run() {
  for (;;) {
    std::optional<Task> next = next_task();
    if (!next) return;
    std::optional<JobPart> part;
    try {
      part = advance(*next);
    } catch (const Cancelled&) {
      // The job stopped because it was no longer wanted. It may be wanted again now.
    }
    put_back(std::move(*next), std::move(part));
    on_news_();
  }
}

void Worker::put_back(Task task, std::optional<JobPart> part) {
  const bool is_done = part && part->is_last;
  const std::scoped_lock lock(mutex_);
  running_.clear();
  const bool is_still_wanted = is_wanted(task.job.key);
  if (part && (is_still_wanted || task.job.is_brief)) {
    news_.push_back(std::move(*part));
    arrived_.notify_all();
  }
  if (!is_still_wanted) return;
  if (is_done) return finished_.push_back(task.job.key);
  const auto rank = [this](const Task& one) { return std::ranges::find(wanted_, one.job.key); };
  const auto next = std::ranges::find_if(tasks_, [&](const Task& other) { return rank(other) > rank(task); });
  tasks_.insert(next, std::move(task));
}

JobPart Worker::advance(Task& task) {
  Job& job = task.job;
  if (job.tolerance > job.scene.number("accuracy.tolerance"))
    job.scene = job.scene.with("accuracy.tolerance", job.tolerance);
  const PointList& list = job.parts[task.next_part];
  const auto start = std::chrono::steady_clock::now();
  const Results results =
      evaluate_(job.scene, list,
                {.keep_all = job.keep_all, .progress = [&](std::size_t, std::size_t) { return may_continue(job); }});
  JobPart news{.key = job.key, .part = task.next_part, .scene = job.scene, .points = points_of(list, results)};
  task.wall_s += seconds_since(start);
  task.evaluations += results.integrand_evaluations;
  news.is_last = ++task.next_part == job.parts.size();
  if (!news.is_last) return news;
  news.wall_s = task.wall_s;
  news.evaluations = task.evaluations;
  if (!job.wants_effects) return news;
  news.csv = to_csv(list.columns(), results);
  news.effects = effects(job.scene, list.columns(), job.keep_all);
  return news;
}

}  // namespace dolp::explore
