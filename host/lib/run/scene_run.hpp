// The one way of every front end: entries of a scene -> moments and beams -> radiometry -> sink.
#pragma once

#include <utility>
#include <vector>

#include "model/evaluator.hpp"
#include "model/point_result.hpp"
#include "model/scene_entry.hpp"
#include "plan/effects.hpp"
#include "run/self_check.hpp"
#include "scene/points.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// The scene's grid.
/// Errors: InputError for more than kMostTableEntries.
SceneEntries grid_entries(const Scene& scene);

/// Scattered points; what they do not say comes from the scene. Points of which only the direction is said are a grid.
/// Errors: InputError that names the points' file and line, column, value and what is allowed: theta_deg is neither in
/// the points nor a single value in the grid; n without k, or k without n, beside a material that depends on the
/// wavelength; q <= 3/2 with smith masking and the cauchy distribution.
SceneEntries point_entries(const Scene& scene, const Points& points);

/// Refuses a q of the points that the scene's masking is not made for: q <= 3/2 with smith and the cauchy distribution;
/// the scene's own q has passed the same check.
/// Errors: InputError that names the points' file and line, column, value and what is allowed.
void check_smith(const Scene& scene, const Points& points);

/// Where results go, part by part.
class Sink {
 public:
  virtual ~Sink() = default;
  /// Whether the results of a part are there already, so that it need not be computed.
  virtual bool has(const SceneEntries& /*part*/) { return false; }
  /// Results of `part`: points follow those of the part before, the part of a grid says where it belongs. `check`: of
  /// its entries.
  virtual void write(const SceneEntries& part, std::vector<PointResult> results, const SelfCheck& check) = 0;
};

/// All results in memory, in the order of the entries.
class CollectedResults final : public Sink {
 public:
  /// `entries` must outlive the object.
  explicit CollectedResults(const SceneEntries& entries) : entries_(entries) {}
  void write(const SceneEntries& part, std::vector<PointResult> results, const SelfCheck& check) override;
  std::vector<PointResult> take() { return std::move(results_); }

 private:
  const SceneEntries& entries_;
  std::vector<PointResult> results_;
};

/// The parts in which a run goes through its entries, which bounds its memory: whole directions of a grid where they
/// fit.
std::vector<SceneEntries> run_parts(const SceneEntries& entries, std::size_t spectral_samples);

/// Whether anything is left for an evaluator: the plan needs moments or beams, and not all entries have closed forms.
bool wants_evaluator(const Scene& scene, const SceneEntries& entries, const EffectPlan& plan);

/// Goes all the way, part by part: what the plan keeps, computed again where it misses the tolerance; what the plan
/// does not give is NaN. Progress counts entries. The evaluator may be null where wants_evaluator says so. Of grids
/// some entries are checked; a direction in which a bound fails gets the status of a missed tolerance. What an entry of
/// a grid gets depends on its direction and index alone, and on the slope distributions of the grid, not on the parts.
/// Errors: those of the evaluator, of Radiometry and of the sink; Cancelled when `progress` returns false.
SelfCheck run_scene(const Scene& scene, const SceneEntries& entries, const EffectPlan& plan,
                    MomentsEvaluator* evaluator, Sink& sink, const Progress& progress);

/// The same into memory: results in the order of `entries`.
std::vector<PointResult> evaluate_scene(const Scene& scene, const SceneEntries& entries, const EffectPlan& plan,
                                        MomentsEvaluator* evaluator, const Progress& progress);

/// The same with everything kept.
std::vector<PointResult> evaluate_scene(const Scene& scene, const SceneEntries& entries, MomentsEvaluator& evaluator,
                                        const Progress& progress);

}  // namespace dolp
