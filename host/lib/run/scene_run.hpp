// The pipeline of every front end: entries of a scene -> moments and beams -> radiometry -> sink.
#pragma once

#include <chrono>
#include <dolp/options.hpp>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include <dolp/results.hpp>
#include "model/evaluator.hpp"
#include "model/scene_entry.hpp"
#include "plan/effects.hpp"
#include "run/run_summary.hpp"
#include "scene/points.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// The scene's grid.
/// Errors: InputError for more than kMostTableEntries.
SceneEntries grid_entries(const SceneValues& scene);

/// Scattered points; values that they lack come from the scene. Points that give only the direction form a grid.
/// Errors: InputError that names the points' file and line, column, value and what is allowed: theta_deg is neither in
/// the points nor a single value in the grid; n without k, or k without n, beside a material that depends on the
/// wavelength; q <= 3/2 with smith masking and the cauchy distribution.
SceneEntries point_entries(const SceneValues& scene, const Points& points);

/// Refuses points that do not fit the scene's surface: q <= 3/2 with smith masking and the cauchy distribution, winds
/// without the gaussian distribution, numbers of films that the scene lacks, n and k of a film that has a material.
/// Errors: InputError that names the points' file and line, column, value and what is allowed.
void check_surface(const SceneValues& scene, const Points& points);

/// Refuses a scene with several materials or bands if the points do not choose among them. Without points (a Mueller
/// matrix, a fit) the scene must have one. Errors: InputError with what to do.
void check_labels_chosen(const SceneValues& scene, const Points& points = {});

/// Destination of results, part by part.
class Sink {
 public:
  virtual ~Sink() = default;
  /// The parts that an earlier run left, which come first and are not computed again, and their summary.
  virtual std::size_t parts_done() const { return 0; }
  virtual RunSummary summary_of_done() const { return {}; }
  /// Takes the results of `part`. Points follow the points of the part before; a part of a grid has its position.
  /// `so_far`: summary of all parts up to this one.
  virtual void write(const SceneEntries& part, std::vector<PointResult> results, const RunSummary& so_far) = 0;
};

/// All results in memory, in the order of the entries.
class CollectedResults final : public Sink {
 public:
  /// `entries` must outlive the object.
  explicit CollectedResults(const SceneEntries& entries) : entries_(entries) {}
  void write(const SceneEntries& part, std::vector<PointResult> results, const RunSummary& so_far) override;
  std::vector<PointResult> take() { return std::move(results_); }

 private:
  const SceneEntries& entries_;
  std::vector<PointResult> results_;
};

/// Calls a function with the results of each part.
class CallbackSink final : public Sink {
 public:
  using Take = std::function<void(const SceneEntries& part, const std::vector<PointResult>& results)>;
  explicit CallbackSink(Take take) : take_(std::move(take)) {}
  void write(const SceneEntries& part, std::vector<PointResult> results, const RunSummary&) override {
    take_(part, results);
  }

 private:
  Take take_;
};

/// Makes the evaluator, when it is needed.
using EvaluatorMaker = std::function<ModelEvaluator*()>;

/// The outcome of a run.
struct RunOutcome {
  EffectPlan plan;
  std::vector<Effect> effects;
  RunSummary summary;           ///< summary of all parts, including parts that were there already
  EvaluationReport evaluation;  ///< evaluation of all parts
  double wall_s = 0.0;
  double file_s = 0.0;  ///< part of wall_s: waiting until the table was written
};

/// A run of a scene over a grid, a part of one, or points: the pipeline of every front end. The constructor decides
/// what will be computed; the results of a part of a grid follow from the whole grid.
class Run {
 public:
  /// `scene` must outlive the object. Tells `options.progress` that all inputs are read, then makes the evaluator if
  /// one is needed. Errors: errors of make_evaluator; Cancelled.
  Run(const SceneValues& scene, SceneEntries entries, const RunOptions& options, const EvaluatorMaker& make_evaluator);

  const SceneEntries& entries() const { return entries_; }
  const EffectPlan& plan() const { return outcome_.plan; }
  /// The evaluator in use; "none" where no work is left for one.
  const EvaluationReport& evaluation() const { return outcome_.evaluation; }
  /// The parts that the run processes one by one, which bounds its memory: whole directions of a grid where they fit.
  std::vector<SceneEntries> parts() const;

  /// Drives the whole pipeline, part by part: it computes what the plan keeps, and computes again where results miss
  /// the tolerance; quantities outside the plan are NaN. Progress counts entries. Some entries of a grid are checked; a
  /// direction in which a bound fails gets the status of a missed tolerance. The result of an entry of a grid depends
  /// on its direction and index, and on the slope distributions of the grid, not on the parts. Errors: errors of the
  /// evaluator, Radiometry and the sink; Cancelled.
  RunOutcome compute(Sink& sink);

  /// Time since the object was made.
  double wall_s() const;

 private:
  const SceneValues& scene_;
  SceneEntries entries_;
  Progress progress_;
  ModelEvaluator* evaluator_ = nullptr;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  RunOutcome outcome_;
};

/// The parts that a run processes one by one.
std::vector<SceneEntries> run_parts(const SceneEntries& entries, std::size_t spectral_samples);

/// The number of spectral samples of an entry; the largest, where entries differ in their band or material.
std::size_t spectral_samples(const SceneValues& scene, const SceneEntries& entries);

/// Calls `progress`, if there is one, with nothing done yet: all inputs are read. Errors: Cancelled.
void report_start(const Progress& progress, std::size_t total);

/// Run::compute with an existing plan and evaluator. The evaluator may be null if the plan leaves nothing for it.
RunSummary run_scene(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan,
                     ModelEvaluator* evaluator, Sink& sink, const Progress& progress);

/// run_scene into memory: results in the order of `entries`. Without a plan everything is kept.
std::vector<PointResult> evaluate_scene(const SceneValues& scene, const SceneEntries& entries,
                                        ModelEvaluator& evaluator, const Progress& progress,
                                        const std::optional<EffectPlan>& plan = {});

}  // namespace dolp
