#include "explore/background.hpp"

#include <algorithm>
#include <exception>

#include "base/stopwatch.hpp"

namespace dolp::explore {

bool BackgroundTask::start(const Work& work) {
  if (is_running()) return false;
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
  return true;
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
  if (std::exchange(column_, column) != column) shown_.reset();  // the old points belong to another axis
}

Worker::Worker(Evaluate evaluate, std::function<void()> on_news)
    : evaluate_(std::move(evaluate)),
      on_news_(std::move(on_news)),
      thread_(run_in_background([this] { run(); }, end_, on_news_)) {}

Worker::~Worker() {
  {
    const std::scoped_lock lock(mutex_);
    is_stopping_ = true;
  }
  changed_.notify_all();
}

void Worker::want(std::vector<Job> jobs) {
  {
    const std::scoped_lock lock(mutex_);
    std::vector<Task> wanted;
    for (Job& job : jobs) {
      const Task* const known = find(job.key);
      wanted.push_back(known ? *known : Task{std::move(job)});
    }
    tasks_ = std::move(wanted);
  }
  changed_.notify_all();
}

void Worker::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return is_stopping_ || !std::ranges::all_of(tasks_, &Task::is_done); });
    if (is_stopping_) return;
    const Job job = std::ranges::find(tasks_, false, &Task::is_done)->job;
    is_running_ = true;
    lock.unlock();
    std::optional<JobResult> result;
    try {
      result = compute(job);
    } catch (const Cancelled&) {
      // The job is no longer wanted, or the worker ends. If the job is wanted again, this loop computes it again.
    }
    lock.lock();
    is_running_ = false;
    Task* const wanted = find(job.key);
    if (result && wanted) wanted->is_done = true;
    if (result && (wanted || job.is_brief)) news_.push_back(std::move(*result));
    lock.unlock();
    arrived_.notify_all();
    on_news_();
    lock.lock();
  }
}

JobResult Worker::compute(const Job& job) {
  JobResult news{.key = job.key, .scene = job.scene, .list = job.list};
  std::vector<Setting> settings = job.settings;
  if (job.tolerance > job.scene.number("accuracy.tolerance")) settings.push_back({"accuracy.tolerance", job.tolerance});
  const auto start = std::chrono::steady_clock::now();
  const auto progress = [&](std::size_t, std::size_t) { return may_continue(job); };
  try {
    if (!settings.empty()) news.scene = job.scene.with(settings);
    news.results = evaluate_(news.scene, job.list.columns(), {.keep_all = job.keep_all, .progress = progress});
  } catch (const InputError& error) {
    news.refusal = error.what();
    news.results.status.assign(job.list.size(), kOutsideModelDomain);
  }
  news.points = result_points(job.list, news.results);
  news.wall_s = seconds_since(start);
  const bool has_effects = job.wants_effects && news.refusal.empty();
  if (has_effects) news.effects = effects(news.scene, job.list.columns(), job.keep_all);
  return news;
}

}  // namespace dolp::explore
