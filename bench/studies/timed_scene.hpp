// Times a scene as a user runs it.
#pragma once

#include <vector>

#include "plan/effects.hpp"
#include "run/scene_run.hpp"

namespace dolp::bench {

/// Plan and evaluation of a scene's grid, again and again.
class TimedScene {
 public:
  /// Runs the scene once, which creates the pipelines. The evaluator must outlive the object.
  TimedScene(SceneValues scene, bool keep_all, ModelEvaluator& evaluator);

  /// Adds a raw time of a call.
  void repeat();

  const SceneValues& scene() const { return scene_; }
  const SceneEntries& entries() const { return entries_; }
  const EffectPlan& plan() const { return plan_; }
  const std::vector<PointResult>& results() const { return results_; }
  const Work& work() const { return work_; }  ///< work of the last call
  /// Raw times per entry in seconds, of calls and of their kernels.
  std::vector<double> times_s() const;
  std::vector<double> kernel_times_s() const;

 private:
  Work run();
  std::size_t calls_of_a_raw_time();

  SceneValues scene_;
  SceneEntries entries_;
  bool keep_all_;
  ModelEvaluator& evaluator_;
  EffectPlan plan_;
  std::vector<PointResult> results_;
  Work work_;
  double first_s_ = 0.0;
  std::size_t calls_ = 0;
  std::vector<double> raw_s_, raw_kernel_s_;
};

}  // namespace dolp::bench
