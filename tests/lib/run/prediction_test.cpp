// predict_run() predicts how many requests, moments and beams a run needs. The test compares these numbers with runs.
#include <gtest/gtest.h>

#include <string>

#include "draws.hpp"
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "run/prediction.hpp"
#include "run/scene_run.hpp"
#include "scene_run_support.hpp"

namespace prediction_test {

using namespace dolp;
using namespace scene_run_support;

/// Counts the requests of the first refinement level. After this level the run checks itself with requests that have
/// extra splits. The count ends at the first of these.
class FirstRequests final : public ModelEvaluator {
 public:
  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override {
    is_over |= request.has_extra_splits;
    if (!is_over) moments += request.size();
    if (!is_over) ++requests;
    return own_.evaluate(request, progress);
  }
  std::vector<ScatteringMatrix> scatter(const ScatteringRequest& request, const Progress& progress) override {
    if (!is_over) beams += request.entries.size();
    return own_.scatter(request, progress);
  }
  EvaluationReport report() const override { return own_.report(); }

  bool is_over = false;
  std::size_t requests = 0, moments = 0, beams = 0;

 private:
  CpuEvaluator own_;
};

struct PredictedCase {
  std::string name;
  Masking masking = Masking::kSmith;
  Axes grid;
  bool is_direct = false;
  bool is_bistatic = false;
};

std::vector<PredictedCase> predicted_cases() {
  const std::vector<double> sigma = spaced(0.1, 0.6, 30), q = spaced(1.8, 5.0, 24), few = {0.2, 0.4};
  return {{"each entry by itself", Masking::kSmith, make_axes(spaced(0.0, 80.0, 50), few, {2.0, 3.0, 5.0})},
          {"rows", Masking::kIntegral, make_axes(spaced(0.0, 80.0, 20), few, spaced(2.0, 3.0, 8))},
          {"slope samples", Masking::kVCavity, make_axes(spaced(0.0, 80.0, 20), few, spaced(2.0, 3.0, 8))},
          {"interpolated", Masking::kSmith, make_axes({20.0, 70.0}, sigma, q)},
          {"interpolated, grazing directions apart", Masking::kIntegral, make_axes({20.0, 90.0}, sigma, q)},
          {"responses", Masking::kNone,
           make_axes(spaced(0.0, 80.0, 8), few, {2.0, 3.0}, {}, spaced(1.3, 2.0, 5), spaced(0.1, 0.9, 5))},
          {"responses at nodes, direct emission", Masking::kSmith,
           make_axes({20.0, 70.0}, sigma, q, {}, spaced(1.3, 2.0, 4), spaced(0.1, 0.9, 4)), true},
          {"beams", Masking::kSmith, make_axes(spaced(0.0, 80.0, 10), sigma, {2.0}), false, true}};
}

TEST(Prediction, CountsOfTheFirstLevel_AreThoseOfTheRun) {
  for (const PredictedCase& one : predicted_cases()) {
    SCOPED_TRACE(one.name);
    SceneValues scene = make_scene(Distribution::kCauchy, one.masking, {1.5, 0.2});
    scene.accuracy.tolerance = 1e-3;
    scene.grid = one.grid;
    if (one.is_direct) scene.emission->model = EmissionModel::kDirect;
    if (one.is_bistatic) {
      scene.source.emplace().irradiance = 1.0;
      scene.geometry = {Mode::kBistatic, 40.0, 120.0};
    }
    const SceneEntries entries = grid_entries(scene);
    const EffectPlan plan = keep_everything(scene);
    std::size_t requests = 0, moments = 0;
    const RequestVisitor visitor = [&](const MomentsRequest& request) {
      ++requests;
      moments += request.size();
    };
    const RunPrediction predicted = predict_run(scene, entries, plan, true, visitor);
    EXPECT_EQ(predicted.moments, moments);

    FirstRequests evaluator;
    CollectedResults results(entries);
    const Work work = run_scene(scene, entries, plan, &evaluator, {results.sink()}).work;
    EXPECT_EQ(requests, evaluator.requests);
    EXPECT_EQ(moments, evaluator.moments);
    EXPECT_EQ(predicted.beams, evaluator.beams);
    if (predicted.again_share == 0.0) {
      EXPECT_EQ(predicted.interpolated, work.interpolated);
    }
    EXPECT_NEAR(predicted.first_evaluations + predicted.again_evaluations, work.evaluations, 0.25 * work.evaluations);
  }
}

}  // namespace prediction_test
