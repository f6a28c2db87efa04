#pragma once

#include <unistd.h>
#include <dolp/dolp.hpp>

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "model/evaluator.hpp"
#include "report/report.hpp"
#include "run/scene_run.hpp"
#include "scene/points.hpp"
#include "scene/scene.hpp"
#include "table/table.hpp"

namespace dolp {

struct Scene::Impl {
  SceneValues scene;
  std::vector<Attribute> table_attributes = {};  ///< see Scene::table_attributes()
};

Report public_report(const ReportBuilder& report, bool is_good = true, const std::filesystem::path& output = {});

std::vector<std::string> scene_files(const SceneValues& scene);

/// Refuses an output file that would overwrite an input file; "-" (stdin, stdout) is no file. Errors: InputError.
void check_output_is_no_input(const std::filesystem::path& output, const std::vector<std::string>& inputs);

/// Makes points from columns. If a column has one value, all points use it. Errors: InputError for a wrong column.
Points points_of_columns(const std::vector<Column>& columns, PointsKind kind);

/// Refuses Vulkan in a process that was forked from one that has used Vulkan. A fork does not copy the threads of the
/// driver, so calls of Vulkan would wait forever.
void check_no_fork();

/// Makes an evaluator, on a device with double precision if `needs_double`. Errors: InputError if no evaluator has the
/// wanted name, or if a device is given but the evaluator is not vulkan. DeviceError if there is no usable device.
std::unique_ptr<ModelEvaluator> make_evaluator(const EvaluatorOptions& wanted, bool needs_double);

struct Evaluator::Impl {
  explicit Impl(EvaluatorOptions given) : options(std::move(given)) {}

  /// Returns the evaluator, with an empty report. Makes a new one if there is none, or none with the needed precision.
  ModelEvaluator* begin(const SceneValues& scene) {
    if (options.evaluator == "vulkan") check_no_fork();
    const bool needs_double = scene.accuracy.precision == Precision::kDouble;
    if (evaluator && (evaluator->has_double() || !needs_double)) {
      evaluator->clear_report();
    } else {
      evaluator = make_evaluator(options, needs_double);
    }
    return evaluator.get();
  }
  /// Returns a new evaluator for beams, which need no device.
  std::unique_ptr<ModelEvaluator> beam_evaluator() const {
    return make_evaluator({.evaluator = options.evaluator == "vulkan" ? "cpu" : options.evaluator}, false);
  }
  EvaluatorMaker maker(const SceneValues& scene) {
    return [this, &scene] { return begin(scene); };
  }

  /// Calls `body` while no other thread uses this object. After a DeviceError, the next call makes a new evaluator.
  /// Errors: InputError if the call comes from a callback of this object.
  template <class Options, class Body>
  auto exclusively(const Scene& scene, Options call_options, const Body& body) {
    if (in_callback == std::this_thread::get_id())
      throw InputError("an Evaluator cannot be called from its own callback; another Evaluator can");
    const std::lock_guard lock(mutex);
    call_options.progress = guard_reentry(call_options.progress);
    if constexpr (requires { call_options.phase; }) call_options.phase = guard_reentry(call_options.phase);
    try {
      return body(scene.impl().scene, call_options);
    } catch (const DeviceError&) {
      // A forked process must not destroy the device, see ~Evaluator().
      owner == getpid() ? evaluator.reset() : static_cast<void>(evaluator.release());
      throw;
    }
  }

  /// Wraps a callback, so that exclusively() refuses calls from inside the callback instead of waiting forever.
  template <class Result, class... Arguments>
  std::function<Result(Arguments...)> guard_reentry(const std::function<Result(Arguments...)>& callback) {
    if (!callback) return callback;
    return [this, callback](Arguments... arguments) {
      in_callback = std::this_thread::get_id();
      const auto end = [this](void*) { in_callback = std::thread::id(); };
      const std::unique_ptr<void, decltype(end)> at_end(this, end);
      return callback(arguments...);
    };
  }

  EvaluatorOptions options;
  std::mutex mutex;
  std::atomic<std::thread::id> in_callback;  ///< thread that is inside a callback of this object
  std::unique_ptr<ModelEvaluator> evaluator;
  pid_t owner = getpid();
};

}  // namespace dolp
