// The thread that computes for the window.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "explore/points.hpp"

namespace dolp::explore {

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
  std::string key;
  std::size_t part = 0;  ///< of the job
  Scene scene;           ///< of the job, with its tolerance
  std::vector<Point> points = {};
  std::string csv = {};  ///< of this part, where the job wants effects
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
  void run_tasks();
  /// Waits for one; none at the end.
  std::optional<Task> next_task();
  JobPart advance(Task& task);
  /// Reports the finished parts of a task; the rest of it goes back to its rank among the wanted jobs.
  void put_back(Task task, std::vector<JobPart> parts);
  bool goes_on(const Job& job) const;

  Evaluate evaluate_;
  std::function<void()> on_news_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Task> tasks_;  ///< without the one under way
  std::vector<std::string> wanted_;
  std::vector<std::string> finished_;  ///< of those wanted
  std::string running_;                ///< empty when none is
  std::vector<JobPart> news_;
  std::exception_ptr failure_;
  bool is_stopping_ = false;
  std::jthread thread_;  ///< last: it uses all of the above
};

}  // namespace dolp::explore
