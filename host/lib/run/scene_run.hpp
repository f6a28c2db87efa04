// The run of a scene, which all front ends use. It computes the results of many entries and passes them to a sink.
#pragma once

#include <chrono>
#include <dolp/options.hpp>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "model/evaluator.hpp"
#include "model/scene_entry.hpp"
#include "plan/effects.hpp"
#include "run/run_results.hpp"
#include "run/run_summary.hpp"
#include "scene/points.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// The entries of the scene's grid. Errors: InputError for more than kMostTableEntries.
SceneEntries grid_entries(const SceneValues& scene);

/// The entries of points. Values that a point lacks come from the scene. Points that have all combinations of
/// directions, slopes and temperatures, in the order of a table, form a grid if it is large enough. Errors: InputError
/// that names the file, the line, the column, and what is allowed.
SceneEntries point_entries(const SceneValues& scene, const Points& points);

/// The slope distribution of one of the points.
SlopeShape shape_at(const SceneValues& scene, const Points& points, std::size_t row);

/// Refuses points whose slope distribution or films do not fit the scene's surface, for example wind speeds without the
/// gaussian distribution. Errors: InputError, as for point_entries().
void check_surface(const SceneValues& scene, const Points& points);

/// Throws InputError if the scene's grid has several materials or bands, and no column of the points chooses one.
void check_labels_chosen(const SceneValues& scene, const Points& points = {});

/// A receiver of the results of a run, part by part. Parts of a list of points come in the order of the points.
/// `so_far` is the summary of all parts up to this one.
using Sink = std::function<void(const SceneEntries& part, RunResults results, const RunSummary& so_far)>;

/// The parts that an earlier run finished. A new run skips them at its beginning.
struct Finished {
  std::size_t parts = 0;
  RunSummary summary = {};
};

class CollectedResults {
 public:
  explicit CollectedResults(const SceneEntries& entries) : entries_(entries) {}
  Sink sink();
  RunResults take() { return std::move(results_); }

 private:
  const SceneEntries& entries_;
  RunResults results_;
};

/// A function that makes the evaluator. A run calls it only if something must be computed.
using EvaluatorMaker = std::function<ModelEvaluator*()>;

struct RunOutcome {
  EffectPlan plan;
  std::vector<Effect> effects;
  RunSummary summary;           ///< summary of all parts, also of those that an earlier run finished
  EvaluationReport evaluation;  ///< device and precision of this run, and the work for all parts
  double wall_s = 0.0;
  // Parts of wall_s. `summary` and `evaluation` have others.
  double spectral_rule_s = 0.0;  ///< for the samples of the spectrum, and for the effects that follow from them
  double estimates_s = 0.0;      ///< for the estimated error of single scattering
  double derivatives_s = 0.0;    ///< for the derivatives, without the time that `evaluation` contains
  double file_s = 0.0;           ///< in which the run waited for the table to be written
};

/// A run of a scene over a grid, a part of a grid, or points. The constructor decides which effects are computed. It
/// decides for the whole grid, so that all parts of a grid have the same effects.
class Run {
 public:
  /// `scene` must outlive the object. Calls `options.progress` when all inputs are read, then makes the evaluator if
  /// one is needed. Errors: errors of scene_derivatives() and make_evaluator; Cancelled.
  Run(const SceneValues& scene, SceneEntries entries, const RunOptions& options, const EvaluatorMaker& make_evaluator);

  const SceneEntries& entries() const { return entries_; }
  const EffectPlan& plan() const { return outcome_.plan; }
  /// Describes the evaluator and its work. If the run needs no evaluator, the device and the other texts are "none".
  const EvaluationReport& evaluation() const { return outcome_.evaluation; }
  const std::vector<std::string>& derivative_keys() const { return derivative_keys_; }
  /// The columns of the derivatives by these keys, without values.
  const std::vector<DerivativeColumn>& derivatives() const { return derivatives_; }
  std::vector<SceneEntries> parts() const;

  /// Computes all parts that are not finished and passes their results to `sink`. Results that miss the tolerance are
  /// computed again. Progress counts entries. As a check, some entries of a grid, or of a list with responses, are
  /// computed a second time. If the two results of an entry differ by more than their error bounds, all entries in its
  /// direction, or in its part of the list, get the status bits of missed tolerances. Errors: errors of the evaluator,
  /// Radiometry and the sink; Cancelled.
  RunOutcome compute(const Sink& sink, const Finished& finished = {});

  double wall_s() const;  ///< time in s since the object was made

 private:
  /// Adds the derivatives to the results of a part. `done`: number of entries that are computed.
  void add_derivatives(const SceneEntries& part, std::size_t done, RunResults& results);

  const SceneValues& scene_;
  SceneEntries entries_;
  std::vector<std::string> derivative_keys_;
  std::vector<DerivativeColumn> derivatives_;
  Progress progress_;
  ModelEvaluator* evaluator_ = nullptr;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  RunOutcome outcome_;
};

std::vector<SceneEntries> run_parts(const SceneEntries& entries, std::size_t spectral_samples);

void report_start(const Progress& progress, std::size_t total);

struct RunOutput {
  Sink sink;
  Progress progress = {};
  Finished finished = {};
};

/// Does what Run::compute does, with a given plan and evaluator. The evaluator may be null if the plan needs none.
RunSummary run_scene(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan,
                     ModelEvaluator* evaluator, const RunOutput& output);

/// Calls run_scene and returns the results in the order of `entries`. Without a plan, all effects are kept.
std::vector<PointResult> evaluate_scene(const SceneValues& scene, const SceneEntries& entries,
                                        ModelEvaluator& evaluator, const Progress& progress,
                                        const std::optional<EffectPlan>& plan = {});

}  // namespace dolp
