// The main promise of the program: each result meets the tolerance, or reports that it misses it. The test computes
// 2,000 random points with the Vulkan evaluator, as `dolp eval` does. Exact values come from the reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include <dolp/results.hpp>
#include "properties_support.hpp"
#include "run/scene_run.hpp"
#include "spectrum/planck.hpp"
#include "stored_evaluator.hpp"
#include "verify/qualification.hpp"

namespace dolp::accuracy_test {
namespace {

// Largest share of points that may miss the tolerance because of rounding. For tolerances below kTight the share is
// kTightMissedShare, because then the limited order of the quadrature rules makes more points miss it.
constexpr double kMissedShare = 0.01;
constexpr double kTightMissedShare = 0.04;
constexpr double kTight = 1e-8;
// Largest allowed median of the stated error divided by the true error. The stated error is at least 4 times the
// difference between a coarse and a fine quadrature rule. The result comes from the fine rule, whose true error is far
// smaller than this difference. So the median is much larger than 1.
constexpr double kMedianPessimism = 100.0;
// The median leaves out points whose true error is below a limit, because rounding causes such errors. The limit for
// float is about 16 times 2^-24. The limit for double is ten times the error of the reference, 1e-12.
constexpr double kFloatRounding = 1e-6;
constexpr double kDoubleRounding = 1e-11;

enum class Light { kEmission, kSurroundingsAndSource };

struct Setting {
  double tolerance;
  Precision precision;
  Light light;
};

SceneValues scene_of(const Model& model, const Setting& setting) {
  SceneValues scene = emission_scene(model.distribution, model.masking, setting.tolerance);
  scene.accuracy.precision = setting.precision;
  if (setting.light == Light::kEmission) return scene;
  scene.surroundings = Surroundings{250.0};
  scene.source = Source{};
  scene.source->irradiance = 0.6 * std::numbers::pi * planck_radiance(10.6, scene.emission->temperature_K);
  return scene;
}

/// A point with its result by the program and its result from the moments of the reference.
struct Compared {
  StoredCase point;
  PointResult result;
  PointResult reference;

  double rho_error() const {
    return std::max(std::abs(result[Quantity::kRhoI] - reference[Quantity::kRhoI]),
                    std::abs(result[Quantity::kRhoQ] - reference[Quantity::kRhoQ])) /
           reference[Quantity::kRhoI];
  }
  double dolp_error() const { return std::abs(result[Quantity::kDolp] - reference[Quantity::kDolp]); }
  bool is_missed() const { return (result.status & kAnyToleranceNotMet) != 0; }
  bool promises_dolp() const { return dolp::promises_dolp(result.status); }
  std::string name() const {
    return to_name(Model{point.distribution, point.masking}) + " " +
           text_of(Point{point.theta_deg, point.shape, point.index});
  }
};

struct Sweep {
  std::vector<Compared> points;
  double rounding = 0.0;
};

void add_group(Sweep& sweep, const std::vector<StoredCase>& cases, const SceneValues& scene,
               ModelEvaluator& evaluator) {
  std::vector<SceneEntry> entries;
  for (const StoredCase& c : cases) entries.push_back({c.theta_deg, c.shape, c.index});
  const std::vector<PointResult> results = evaluate_scene(scene, entries, evaluator, {});
  StoredEvaluator stored(cases);
  const std::vector<PointResult> references = evaluate_scene(scene, entries, stored, {});
  for (std::size_t i = 0; i < cases.size(); ++i) sweep.points.push_back({cases[i], results[i], references[i]});
}

Sweep sweep_of(const std::vector<StoredCase>& cases, const Setting& setting, ModelEvaluator& evaluator) {
  Sweep sweep;
  for (const Model& model : kModels) {
    const std::vector<StoredCase> own = cases_of(cases, model.distribution, model.masking);
    add_group(sweep, own, scene_of(model, setting), evaluator);
  }
  sweep.rounding = evaluator.report().precision == "float" ? kFloatRounding : kDoubleRounding;
  return sweep;
}

void expect_within_tolerance_and_estimates(const Sweep& sweep, double tolerance) {
  double worst_rho = 0.0;
  double worst_dolp = 0.0;
  for (const Compared& c : sweep.points) {
    EXPECT_LE(c.rho_error(), c.result[Quantity::kRhoErrorEstimate] + c.reference[Quantity::kRhoErrorEstimate])
        << c.name();
    EXPECT_LE(c.dolp_error(), c.result[Quantity::kErrorEstimate] + c.reference[Quantity::kErrorEstimate]) << c.name();
    if (c.is_missed()) continue;
    worst_rho = std::max(worst_rho, c.rho_error());
    EXPECT_LE(c.rho_error(), tolerance + c.reference[Quantity::kRhoErrorEstimate]) << c.name();
    if (!c.promises_dolp()) continue;
    worst_dolp = std::max(worst_dolp, c.dolp_error());
    EXPECT_LE(c.dolp_error(), tolerance + c.reference[Quantity::kErrorEstimate]) << c.name();
  }
  std::printf("worst error of rho %.1e, of dolp %.1e at tolerance %.0e\n", worst_rho, worst_dolp, tolerance);
}

void expect_few_misses(const std::vector<Compared>& points, double tolerance) {
  const auto missed = std::ranges::count_if(points, &Compared::is_missed);
  std::printf("%td of %zu points say that they miss %.0e\n", missed, points.size(), tolerance);
  const double share = tolerance < kTight ? kTightMissedShare : kMissedShare;
  EXPECT_LT(static_cast<double>(missed), share * static_cast<double>(points.size()));
}

void expect_moderate_estimates(const Sweep& sweep) {
  std::vector<double> pessimism;
  for (const Compared& c : sweep.points) {
    if (c.rho_error() > sweep.rounding) pessimism.push_back(c.result[Quantity::kRhoErrorEstimate] / c.rho_error());
  }
  std::ranges::sort(pessimism);
  const double median = pessimism.empty() ? 0.0 : pessimism[pessimism.size() / 2];
  std::printf("median of estimate over error %.1f, of %zu points above rounding\n", median, pessimism.size());
  EXPECT_LT(median, kMedianPessimism);
}

void expect_kept_promises(const std::vector<double>& tolerances, Precision precision) {
  VulkanOptions options;
  options.needs_double = precision == Precision::kDouble;
  VulkanEvaluator evaluator(options);
  const std::vector<StoredCase> cases = read_stored_cases(DOLP_TEST_DATA_DIR "/random_points.csv");
  EXPECT_EQ(std::ranges::count(cases, "random-a", &StoredCase::name), 1504);
  EXPECT_EQ(std::ranges::count(cases, "random-b", &StoredCase::name), 496);
  for (const double tolerance : tolerances) {
    for (const Light light : {Light::kEmission, Light::kSurroundingsAndSource}) {
      SCOPED_TRACE(fmt::format("{}, tolerance {}", light == Light::kEmission ? "emission" : "all light", tolerance));
      const Sweep sweep = sweep_of(cases, {tolerance, precision, light}, evaluator);
      EXPECT_EQ(sweep.points.size(), cases.size());
      expect_within_tolerance_and_estimates(sweep, tolerance);
      expect_few_misses(sweep.points, tolerance);
      expect_moderate_estimates(sweep);
    }
  }
}

TEST(RandomPoints, InFloatFirst_MeetTheirToleranceOrSaySo_WithinTheirEstimates) {
  expect_kept_promises({1e-2, 1e-4, 1e-6}, Precision::kAuto);
}

TEST(RandomPoints, InDouble_MeetTheirToleranceOrSaySo_WithinTheirEstimates) {
  expect_kept_promises({1e-9}, Precision::kDouble);
}

}  // namespace
}  // namespace dolp::accuracy_test
