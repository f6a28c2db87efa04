// A scene as a user runs it, timed.
#pragma once

#include <vector>

#include "effects/effects.hpp"
#include "evaluate/run/scene_run.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"

namespace dolp::bench {

/// Plan and evaluation of a scene's grid on the Vulkan device, again and again.
class TimedScene {
 public:
  /// Runs it once, which creates the pipelines. The evaluator outlives the object.
  TimedScene(Scene scene, bool keep_all, VulkanEvaluator& evaluator);

  /// Adds a raw time of a call.
  void repeat();

  const Scene& scene() const { return scene_; }
  const std::vector<SceneEntry>& entries() const { return entries_; }
  const EffectPlan& plan() const { return plan_; }
  const std::vector<PointResult>& results() const { return results_; }
  double evaluations() const { return evaluations_; }  ///< of one call
  /// Raw times in seconds an entry, of calls and of their kernels.
  std::vector<double> times_s() const;
  std::vector<double> kernel_times_s() const;

 private:
  std::vector<PointResult> run();
  std::size_t calls_of_a_raw_time();

  Scene scene_;
  std::vector<SceneEntry> entries_;
  bool keep_all_;
  VulkanEvaluator& evaluator_;
  EffectPlan plan_;
  std::vector<PointResult> results_;
  double first_s_ = 0.0;
  double evaluations_ = 0.0;
  std::size_t calls_ = 0;
  std::vector<double> raw_s_, raw_kernel_s_;
};

}  // namespace dolp::bench
