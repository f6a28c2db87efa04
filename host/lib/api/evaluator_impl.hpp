// Implementation of the public evaluator.
#pragma once

#include <unistd.h>
#include <dolp/dolp.hpp>

#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "api/named_evaluator.hpp"
#include "run/scene_run.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// Refuses Vulkan in a process that was forked from one that has used it: drivers keep threads and locks that a fork
/// does not copy, so that calls would wait without end.
void check_no_fork();

struct Evaluator::Impl {
  explicit Impl(EvaluatorOptions own) : options(std::move(own)) {}

  /// The evaluator for a scene, before a run; a scene in double gets a device that has it. Errors: those of
  /// make_evaluator.
  MomentsEvaluator* begin(const SceneValues& scene) {
    const bool needs_double = scene.accuracy.precision == Precision::kDouble;
    if (!evaluator || (needs_double && !evaluator->has_double())) evaluator = make_evaluator(options, needs_double);
    evaluator->clear_report();
    return evaluator.get();
  }
  EvaluatorMaker maker(const SceneValues& scene) {
    return [this, &scene] { return begin(scene); };
  }

  /// Calls `body` while no other thread uses the evaluators; a device that failed is not used again.
  template <class Body>
  auto exclusively(const Body& body) {
    if (options.evaluator == "vulkan") check_no_fork();
    const std::lock_guard lock(mutex);
    try {
      return body();
    } catch (const DeviceError&) {
      evaluator.reset();
      throw;
    }
  }

  EvaluatorOptions options;
  std::mutex mutex;
  std::unique_ptr<MomentsEvaluator> evaluator;
  pid_t owner = getpid();
};

}  // namespace dolp
