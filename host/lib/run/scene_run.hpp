// What every front end runs: from the entries of a scene to moments and beams, then to results, which a sink receives.
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

/// The entries of the scene's grid. Errors: InputError for more than kMostTableEntries.
SceneEntries grid_entries(const SceneValues& scene);

/// The entries of scattered points. Values that a point lacks come from the scene. Points that give only theta form a
/// grid. Errors: InputError that names file and line of the point, column, value and what is allowed. It refuses points
/// without theta_deg if the grid has several values of theta, points with only one of n and k if the material depends
/// on the wavelength, and points that check_surface() refuses.
SceneEntries point_entries(const SceneValues& scene, const Points& points);

/// Refuses points that do not fit the scene's surface: q <= 3/2 with smith masking and the cauchy distribution; wind
/// speeds without the gaussian distribution; values of films that the scene lacks; n or k of a film for which the scene
/// names a material. Errors: InputError as for point_entries().
void check_surface(const SceneValues& scene, const Points& points);

/// Refuses points without a column of materials (or bands) if the scene's grid has several materials (or bands).
/// Without points, as for a Mueller matrix or a fit, refuses every such grid. Errors: InputError that tells what to do.
void check_labels_chosen(const SceneValues& scene, const Points& points = {});

/// A receiver of the results of a run, part by part.
class Sink {
 public:
  virtual ~Sink() = default;
  /// The number of parts that an earlier run finished, and their summary. They come first, and this run skips them.
  virtual std::size_t parts_done() const { return 0; }
  virtual RunSummary summary_of_done() const { return {}; }
  /// Receives the results of `part`. Parts of a list of points come in the order of the points; a part of a grid knows
  /// its position in the grid. `so_far`: summary of all parts up to this one.
  virtual void write(const SceneEntries& part, std::vector<PointResult> results, const RunSummary& so_far) = 0;
};

/// A sink that collects all results in memory, in the order of the entries.
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

/// A function that makes the evaluator. A run calls it only if something must be computed.
using EvaluatorMaker = std::function<ModelEvaluator*()>;

struct RunOutcome {
  EffectPlan plan;
  std::vector<Effect> effects;
  RunSummary summary;           ///< summary of all parts, also of those that an earlier run finished
  EvaluationReport evaluation;  ///< device, precision and work of all parts
  double wall_s = 0.0;
  double file_s = 0.0;  ///< time of waiting for the table to be written, a part of wall_s
};

/// A run of a scene over a grid, a part of a grid, or points. The constructor decides what the run computes. It decides
/// for the whole grid, even if the run is of a part of the grid.
class Run {
 public:
  /// `scene` must outlive the object. Calls `options.progress` when all inputs are read, then makes the evaluator if
  /// one is needed. Errors: errors of make_evaluator; Cancelled.
  Run(const SceneValues& scene, SceneEntries entries, const RunOptions& options, const EvaluatorMaker& make_evaluator);

  const SceneEntries& entries() const { return entries_; }
  const EffectPlan& plan() const { return outcome_.plan; }
  /// The report of the evaluator. If the run needs no evaluator, the device and the other texts in it are "none".
  const EvaluationReport& evaluation() const { return outcome_.evaluation; }
  /// The parts that the run computes one after another to limit its memory: whole directions of a grid if they fit.
  std::vector<SceneEntries> parts() const;

  /// Computes all parts and passes them to `sink`. Quantities that the plan drops are NaN. Results that miss the
  /// tolerance are computed again. Progress counts entries. Some entries of a grid are checked; if an error bound turns
  /// out wrong, all entries of that direction get the status of a missed tolerance. The result of an entry depends on
  /// its direction, its index and the slope distributions of the grid, not on the parts. Errors: errors of the
  /// evaluator, Radiometry and the sink; Cancelled.
  RunOutcome compute(Sink& sink);

  double wall_s() const;  ///< time in s since the object was made

 private:
  const SceneValues& scene_;
  SceneEntries entries_;
  Progress progress_;
  ModelEvaluator* evaluator_ = nullptr;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  RunOutcome outcome_;
};

std::vector<SceneEntries> run_parts(const SceneEntries& entries, std::size_t spectral_samples);

/// The number of spectral samples of an entry. If it differs between bands, materials or films, the largest number.
std::size_t spectral_samples(const SceneValues& scene, const SceneEntries& entries);

/// Tells `progress`, unless it is empty, that no item is finished but all inputs are read. Errors: Cancelled.
void report_start(const Progress& progress, std::size_t total);

/// Does what Run::compute does, for a given plan and evaluator. The evaluator may be null if the plan needs none.
RunSummary run_scene(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan,
                     ModelEvaluator* evaluator, Sink& sink, const Progress& progress);

/// Calls run_scene and returns the results in the order of `entries`. Without a plan, all effects are kept.
std::vector<PointResult> evaluate_scene(const SceneValues& scene, const SceneEntries& entries,
                                        ModelEvaluator& evaluator, const Progress& progress,
                                        const std::optional<EffectPlan>& plan = {});

}  // namespace dolp
