// Measures the times of whole runs of a scene.
#pragma once

#include <vector>

#include "plan/effects.hpp"
#include "run/scene_run.hpp"

namespace dolp::bench {

/// Plans and evaluates the grid of a scene repeatedly, and records the times.
class TimedScene {
 public:
  /// Runs the scene once without recording the time; this compiles the kernels. The evaluator must outlive the object.
  TimedScene(SceneValues scene, bool keep_all, ModelEvaluator& evaluator);

  /// Records one raw time. It is the time of a call, or the mean time of several calls if they are short.
  void repeat();

  const SceneValues& scene() const { return scene_; }
  const SceneEntries& entries() const { return entries_; }
  const EffectPlan& plan() const { return plan_; }
  const RunResults& results() const { return results_; }
  const Work& work() const { return work_; }  ///< evaluations and times of the last call
  /// Raw times of whole runs, per entry, in seconds.
  std::vector<double> times_s() const;
  /// The part of times_s() in which kernels run, or in which the host combines the results of the kernels.
  std::vector<double> kernel_times_s() const;

 private:
  Work run();
  std::size_t calls_of_a_raw_time();

  SceneValues scene_;
  SceneEntries entries_;
  bool keep_all_;
  ModelEvaluator& evaluator_;
  EffectPlan plan_;
  RunResults results_;
  Work work_;
  double first_s_ = 0.0;
  std::size_t calls_ = 0;
  std::vector<double> raw_s_, raw_kernel_s_;
};

}  // namespace dolp::bench
