// What a public evaluator holds.
#pragma once

#include <unistd.h>
#include <dolp/dolp.hpp>

#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "api/named_evaluator.hpp"
#include "api/translated.hpp"
#include "scene/scene.hpp"

namespace dolp::api {

/// Refuses Vulkan in a process that was forked from one that has used it: drivers keep threads and locks that a fork
/// does not copy, so that calls would wait for ever.
void check_no_fork();

struct Evaluator::Impl {
  explicit Impl(EvaluatorOptions own) : options(std::move(own)) {}

  /// The evaluator for a scene, before a run. Errors: those of make_evaluator.
  MomentsEvaluator* begin(const dolp::Scene& scene) {
    const Precision precision = scene.accuracy.precision;
    std::unique_ptr<MomentsEvaluator>& evaluator = evaluators[precision];
    if (!evaluator) evaluator = make_evaluator({options.evaluator, options.device, precision, options.is_interactive});
    evaluator->clear_report();
    return evaluator.get();
  }

  /// Calls `body` with nobody else using the evaluators; a device that failed is not used again.
  template <class Body>
  auto exclusively(const Body& body) {
    return translated([&] {
      if (options.evaluator == "vulkan") check_no_fork();
      const std::lock_guard lock(mutex);
      try {
        return body();
      } catch (const dolp::DeviceError&) {
        evaluators.clear();
        throw;
      }
    });
  }

  EvaluatorOptions options;
  std::mutex mutex;
  std::map<Precision, std::unique_ptr<MomentsEvaluator>> evaluators;
  pid_t owner = getpid();
};

}  // namespace dolp::api
