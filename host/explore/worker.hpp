// The thread that computes for the window.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "evaluate/evaluator.hpp"
#include "model/point_result.hpp"
#include "model/scene_entry.hpp"
#include "plan/effects.hpp"
#include "scene/scene.hpp"

namespace dolp::explore {

/// Entries of a scene that the window wants, computed as `dolp eval` computes them.
struct Job {
  std::string key;  ///< jobs with one key have one content
  Scene scene;
  SceneEntries entries;
  /// What is computed at a time, one after the other; a job of higher rank may come in between. Empty: all at once.
  std::vector<SceneEntries> parts = {};
  bool keep_all = false;
  bool wants_rows = false;  ///< the effects of the plan
  bool is_brief = false;    ///< once begun it is finished, wanted or not
};

/// A part of a job's results.
struct JobPart {
  std::string key;
  std::size_t part = 0;  ///< of the job
  Scene scene;
  SceneEntries entries;  ///< of this part
  std::vector<PointResult> results;
  bool is_last = false;
  // Of the whole job, in the last part.
  std::vector<EffectRow> rows;
  double wall_s = 0.0;
  double evaluations = 0.0;
};

/// Computes what is wanted, in order; what is no longer wanted is given up within a tile of the device, unless brief.
class Worker {
 public:
  /// `on_news` is called from the worker's thread after each part and after a failure. The evaluator must outlive this.
  Worker(MomentsEvaluator& evaluator, std::function<void()> on_news);
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker();

  /// What is wanted from now on, the most wanted first. A job that is under way goes on if its key is still there.
  void want(std::vector<Job> jobs);

  /// What is new since the last call. Errors: rethrows what ended the worker, a DeviceError for instance.
  std::vector<JobPart> take_news();

  /// Nothing is wanted that is not done; its news may still wait to be taken.
  bool is_idle() const;

 private:
  struct Task {
    Job job;
    std::size_t next = 0;  ///< of its parts
    EffectPlan plan;
    double wall_s = 0.0;
    double evaluations = 0.0;
  };

  void run();
  void run_tasks();
  JobPart advance(Task& task);
  /// What was done of a task is news; the rest of it goes back to its rank among what is wanted now.
  void put_back(Task task, std::vector<JobPart> parts);
  bool goes_on(const Job& job) const;

  MomentsEvaluator& evaluator_;
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
