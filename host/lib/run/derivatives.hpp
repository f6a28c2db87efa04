// Derivatives of results by numbers of the scene.
#pragma once

#include <dolp/results.hpp>
#include <span>
#include <string>
#include <vector>

#include "model/evaluator.hpp"
#include "model/scene_entry.hpp"
#include "run/scene_run.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// The columns of the derivatives by `keys`, with units and without values. Errors: InputError that begins with
/// "derivatives: " for a key that is no number of the scene, or appears twice.
std::vector<DerivativeColumn> scene_derivatives(const SceneValues& scene, const SceneEntries& entries,
                                                const std::vector<std::string>& keys);

/// Computes the kDerivativesPerKey columns of the derivatives by a number x of the scene. With D(h) = (f(x + h) - f(x -
/// h)) / (2 h), a derivative is (4 D(h / 2) - D(h)) / 3 with an error of order h^4. The four results come from scenes
/// in double precision with a tolerance of at most 1e-8. The stated error is the difference from D(h / 2), which errs
/// by the order h^2, plus what the bounds of the four results can contribute. Derivatives and error are NaN where a
/// step leaves the domain of the scene. Domain: scene_derivatives() accepts `key`. Errors: errors of the evaluator;
/// Cancelled.
void compute_derivatives(const SceneValues& scene, const SceneEntries& entries, const std::string& key,
                         ModelEvaluator& evaluator, const Progress& progress, std::span<DerivativeColumn> columns);

/// Adds derivatives to the results before they go to another sink.
class WithDerivatives final : public Sink {
 public:
  /// The evaluator may be null if there are no keys. While derivatives are computed, `progress` gets the number of
  /// entries that are finished.
  WithDerivatives(const SceneValues& scene, const std::vector<std::string>& keys,
                  const std::vector<DerivativeColumn>& columns, ModelEvaluator* evaluator, Sink& sink,
                  const Progress& progress)
      : scene_(scene), keys_(keys), columns_(columns), evaluator_(evaluator), sink_(sink), progress_(progress) {}

  std::size_t parts_done() const override { return sink_.parts_done(); }
  RunSummary summary_of_done() const override { return sink_.summary_of_done(); }
  void write(const SceneEntries& part, RunResults results, const RunSummary& so_far) override;
  double time_s() const { return time_s_; }  ///< without the time that the report of the evaluator contains

 private:
  const SceneValues& scene_;
  const std::vector<std::string>& keys_;
  const std::vector<DerivativeColumn>& columns_;  ///< without values
  ModelEvaluator* evaluator_;
  Sink& sink_;
  const Progress& progress_;
  std::size_t done_ = 0;
  double time_s_ = 0.0;
};

}  // namespace dolp
