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
  if (std::exchange(column_, column) == column) return;
  points_.clear();  // the old points belong to another axis
  at_.clear();
}

bool Sweep::take(const JobPart& news) {
  if (!job_ || news.key != job_->key) return false;
  shown_key_ = news.key;
  points_ = news.points;
  csv_ = news.csv;
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
  const auto is_open = [](const Task& task) { return !task.is_done(); };
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return is_stopping_ || std::ranges::any_of(tasks_, is_open); });
    if (is_stopping_) return;
    Task task = *std::ranges::find_if(tasks_, is_open);
    is_running_ = true;
    lock.unlock();
    std::optional<JobPart> part;
    try {
      part = advance(task);
    } catch (const Cancelled&) {
      // The job is no longer wanted, or the worker ends. If the job is wanted again, this loop computes the part again.
    }
    lock.lock();
    is_running_ = false;
    Task* const wanted = find(task.job.key);
    if (part && (wanted || task.job.is_brief)) news_.push_back(std::move(*part));
    if (part && wanted) *wanted = std::move(task);
    lock.unlock();
    arrived_.notify_all();
    on_news_();
    lock.lock();
  }
}

JobPart Worker::advance(Task& task) {
  Job& job = task.job;
  if (job.tolerance > job.scene.number("accuracy.tolerance"))
    job.scene = job.scene.with("accuracy.tolerance", job.tolerance);
  const PointList& list = job.parts[task.next_part];
  const auto start = std::chrono::steady_clock::now();
  const auto progress = [&](std::size_t, std::size_t) { return may_continue(job); };
  JobPart news{.key = job.key, .part = task.next_part, .scene = job.scene};
  Results results;
  try {
    results = evaluate_(job.scene, list, {.keep_all = job.keep_all, .progress = progress});
  } catch (const InputError& error) {
    news.refusal = error.what();
    results.status.assign(list.size(), kOutsideModelDomain);
  }
  news.points = result_points(list, results);
  task.wall_s += seconds_since(start);
  task.evaluations += results.integrand_evaluations;
  news.is_last = ++task.next_part == job.parts.size();
  if (!news.is_last) return news;
  news.wall_s = task.wall_s;
  news.evaluations = task.evaluations;
  if (job.parts.size() == 1) news.csv = to_csv(list.columns(), results);
  if (!job.wants_effects || !news.refusal.empty()) return news;
  for (const Attribute& attribute : results.attributes) {
    const bool is_device = attribute.name == "device" || attribute.name == "driver";
    if (is_device) news.device += (news.device.empty() ? "" : ", ") + std::get<std::string>(attribute.value);
  }
  news.effects = effects(job.scene, list.columns(), job.keep_all);
  return news;
}

}  // namespace dolp::explore
