// Thousands of points, whose responses are interpolated between a few zeniths and slope distributions.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <dolp/status.hpp>
#include "agreement.hpp"
#include "draws.hpp"
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "evaluate/remembering_evaluator.hpp"
#include "model/sky_basis.hpp"
#include "moments_only.hpp"
#include "run/scene_run.hpp"
#include "scene/scene_reader.hpp"

namespace dolp::many_points_test {
namespace {

constexpr std::size_t kPoints = 9000;

SceneValues scene(const std::string& masking, const std::string& more = "") {
  return parse_scene("[surface]\nn = 1.5\nsigma = 0.2\nq = 3\nmasking = \"" + masking +
                         "\"\n[emission]\ntemperature_K = 300\n[spectrum]\nwavelength_um = 10\n"
                         "[accuracy]\ntolerance = 1e-3\n" +
                         more,
                     "s.toml", {});
}

/// Points at all zeniths, also beyond those that are interpolated.
SceneEntries random_points(std::size_t count = kPoints) {
  Draws random(1);
  std::vector<SceneEntry> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back({.theta_deg = random.uniform(0.0, 90.0),
                      .shape = {random.uniform(0.1, 0.4), 3.0},
                      .index = OpticalConstants{random.uniform(1.3, 2.0), random.uniform(0.0, 0.5)}});
  }
  return points;
}

/// Computes on the CPU. Where a run checks itself, r_q is larger than before.
class ShiftsChecks final : public MomentsOnly {
 public:
  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override {
    std::vector<Moments> moments = cpu_.evaluate(request, progress);
    for (Moments& m : moments) m.r_q += request.has_extra_splits ? 0.01 : 0.0;
    return moments;
  }
  bool computes_each_entry() const override { return false; }

 private:
  CpuEvaluator cpu_;
};

TEST(ManyPoints, Interpolated_AgreeWithPointsByThemselves) {
  const SceneEntries points = random_points();
  for (const char* masking : {"none", "v-cavity", "smith", "integral"}) {
    for (const char* sky : {"", "[surroundings]\nprofile = \"clear-sky\"\n"}) {
      SCOPED_TRACE(std::string(masking) + sky);
      SceneValues own = scene(masking, sky);
      CpuEvaluator evaluator;
      CollectedResults collected(points);
      const RunSummary summary = run_scene(own, points, keep_everything(own), &evaluator, {collected.sink()});
      const std::vector<PointResult> results = collected.take().list();
      EXPECT_GT(summary.work.interpolated, kPoints / 2);
      EXPECT_GT(summary.check.entries, 0U);
      EXPECT_LT(summary.check.worst_ratio, 1.0);
      own.accuracy.tolerance = 1e-5;
      own.accuracy.may_interpolate = false;
      std::vector<SceneEntry> some;
      for (std::size_t i = 0; i < kPoints; i += 90) some.push_back(points[i]);
      const std::vector<PointResult> exact = evaluate_scene(own, some, evaluator, {});
      for (std::size_t i = 0; i < exact.size(); ++i) {
        const PointResult& result = results[90 * i];
        SCOPED_TRACE(fmt::format("theta {}, sigma {}", some[i].theta_deg, some[i].shape.sigma));
        EXPECT_EQ(result.status & kAnyToleranceNotMet, 0U);
        expect_agreement(result, exact[i]);
      }
    }
  }
}

TEST(ManyPoints, CheckFindsWrongBounds_NoPointMeetsTheTolerance) {
  const SceneEntries points = random_points();
  const SceneValues own = scene("v-cavity");
  ShiftsChecks evaluator;
  CollectedResults collected(points);
  run_scene(own, points, keep_everything(own), &evaluator, {collected.sink()});
  for (const PointResult& result : collected.take().list())
    EXPECT_EQ(result.status & kAnyToleranceNotMet, kAnyToleranceNotMet);
}

TEST(ManyPoints, FewPoints_AreIntegrated) {
  const SceneEntries points = random_points(8000);
  const SceneValues own = scene("v-cavity");
  CpuEvaluator evaluator;
  EXPECT_EQ(
      run_scene(own, points, keep_everything(own), &evaluator, {CollectedResults(points).sink()}).work.interpolated,
      0U);
}

TEST(RememberingEvaluator, RequestTwice_IsComputedOnce) {
  CpuEvaluator cpu;
  RememberingEvaluator evaluator(cpu, [](const MomentsRequest& request) { return request.shapes.front().sigma > 0.2; });
  MomentsRequest request;
  request.append({30.0, {}, {1.5, 0.1}});
  for (const auto& [sigma, calls] : {std::pair{0.3, 1.0}, std::pair{0.1, 2.0}}) {
    request.shapes = {{sigma, 2.0}};
    const double before = cpu.report().evaluations;
    const Moments first = evaluator.evaluate(request, {}).front();
    const double each = cpu.report().evaluations - before;
    EXPECT_EQ(evaluator.evaluate(request, {}).front().r_i, first.r_i);
    EXPECT_EQ(cpu.report().evaluations - before, calls * each);
  }
}

}  // namespace
}  // namespace dolp::many_points_test
