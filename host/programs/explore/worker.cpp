#include "explore/worker.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

#include "base/stopwatch.hpp"
#include "base/text.hpp"

namespace dolp::explore {
namespace {

using Clock = std::chrono::steady_clock;

Job with_tolerance(Job job) {
  if (job.tolerance > job.scene.number("accuracy.tolerance")) {
    job.scene = job.scene.with("accuracy.tolerance", job.tolerance);
  }
  return job;
}

}  // namespace

Worker::Worker(Evaluate evaluate, std::function<void()> on_news)
    : evaluate_(std::move(evaluate)), on_news_(std::move(on_news)), thread_([this] { run(); }) {}

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
      if (job.key == running_ || contains(finished_, job.key)) continue;
      const auto same = std::ranges::find_if(old, [&](const Task& task) { return task.job.key == job.key; });
      if (same != old.end()) {
        tasks_.push_back(std::move(*same));
        same->job.key.clear();
      } else {
        tasks_.push_back({.job = std::move(job)});
      }
    }
    std::erase_if(finished_, [&](const std::string& key) { return !contains(wanted_, key); });
  }
  changed_.notify_all();
}

std::vector<JobPart> Worker::take_news() {
  const std::scoped_lock lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
  return std::exchange(news_, {});
}

bool Worker::is_idle() const {
  const std::scoped_lock lock(mutex_);
  return (tasks_.empty() && running_.empty()) || failure_ != nullptr;
}

bool Worker::goes_on(const Job& job) const {
  const std::scoped_lock lock(mutex_);
  return !is_stopping_ && (job.is_brief || contains(wanted_, job.key));
}

void Worker::run() {
  try {
    run_tasks();
  } catch (...) {
    const std::scoped_lock lock(mutex_);
    failure_ = std::current_exception();
  }
  on_news_();
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

void Worker::run_tasks() {
  for (;;) {
    std::optional<Task> next = next_task();
    if (!next) return;
    Task& task = *next;
    std::vector<JobPart> parts;
    try {
      parts.push_back(advance(task));
    } catch (const Cancelled&) {
      // The job was no longer wanted; perhaps it is wanted again by now.
    }
    put_back(std::move(task), std::move(parts));
    on_news_();
  }
}

void Worker::put_back(Task task, std::vector<JobPart> parts) {
  const bool is_done = !parts.empty() && parts.front().is_last;
  const std::scoped_lock lock(mutex_);
  running_.clear();
  const bool is_wanted = contains(wanted_, task.job.key);
  if (is_wanted || task.job.is_brief) std::ranges::move(parts, std::back_inserter(news_));
  if (!is_wanted) return;
  if (is_done) {
    finished_.push_back(task.job.key);
    return;
  }
  const auto rank = [this](const Task& of) { return std::ranges::find(wanted_, of.job.key); };
  const auto place = std::ranges::find_if(tasks_, [&](const Task& other) { return rank(other) > rank(task); });
  tasks_.insert(place, std::move(task));
}

JobPart Worker::advance(Task& task) {
  if (task.next == 0) task.job = with_tolerance(std::move(task.job));
  const Job& job = task.job;
  const PointList& list = job.parts[task.next];
  const Clock::time_point start = Clock::now();
  const Results results = evaluate_(
      job.scene, list, {.keep_all = job.keep_all, .progress = [&](std::size_t, std::size_t) { return goes_on(job); }});
  JobPart news{.key = job.key, .part = task.next, .scene = job.scene, .points = points_of(list, results)};
  ++task.next;
  task.wall_s += seconds_since(start);
  task.evaluations += results.integrand_evaluations;
  news.is_last = task.next == job.parts.size();
  if (!news.is_last) return news;
  news.wall_s = task.wall_s;
  news.evaluations = task.evaluations;
  if (!job.wants_effects) return news;
  news.csv = to_csv(list.columns(), results);
  news.effects = effects(job.scene, list.columns(), job.keep_all);
  return news;
}

}  // namespace dolp::explore
