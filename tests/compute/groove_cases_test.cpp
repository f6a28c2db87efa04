// All bounces in V-grooves: every kernel against stored values of the reference, and what must hold whatever the
// inputs, on seeded random draws of the whole range that scenes allow.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <tuple>
#include <vector>

#include <dolp/status.hpp>
#include "model/angles.hpp"
#include "properties_support.hpp"
#include "run/scene_run.hpp"
#include "scene/scene_reader.hpp"
#include "verify/stored_cases.hpp"

namespace dolp {
namespace {

std::vector<StoredCase> stored_cases() { return read_stored_cases(DOLP_TEST_DATA_DIR "/groove_cases.csv"); }

MomentsRequest all_bounces(Distribution distribution, const std::vector<Point>& points, double tolerance) {
  MomentsRequest request = request_of({distribution, Masking::kVCavity}, points, tolerance);
  request.scattering = Scattering::kMultiple;
  return request;
}

std::vector<double> tolerances_of(Kernel kernel) {
  return is_double(kernel) ? std::vector{1e-2, 1e-4, 1e-6} : std::vector{1e-2, 1e-4};
}

// ---- Stored cases --------------------------------------------------------------------------------------------------

class GrooveCasesOn : public testing::TestWithParam<Kernel> {};

TEST_P(GrooveCasesOn, Stored_AreWithinTheBounds) {
  const auto evaluator = make_evaluator(GetParam());
  for (const Distribution distribution : {Distribution::kCauchy, Distribution::kGaussian}) {
    std::vector<StoredCase> cases = stored_cases();
    std::erase_if(cases, [&](const StoredCase& c) { return c.distribution != distribution; });
    std::vector<Point> points;
    for (const StoredCase& c : cases) points.push_back({c.theta_deg, c.shape, c.index});
    for (const double tolerance : tolerances_of(GetParam())) {
      const std::vector<Moments> moments = evaluator->evaluate(all_bounces(distribution, points, tolerance), {});
      double worst = 0.0;
      for (std::size_t i = 0; i < cases.size(); ++i) {
        worst = std::max(worst, expect_within_bounds(cases[i].moments, moments[i], cases[i].name));
      }
      std::printf("%s %.0e: %zu cases, worst %.2g of its bound\n", name_of(distribution), tolerance, cases.size(),
                  worst);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, GrooveCasesOn, testing::ValuesIn(kKernels),
                         [](const auto& test) { return name_of(test.param); });

// ---- Whatever the inputs -------------------------------------------------------------------------------------------

constexpr std::uint64_t kSeed = 20261122;
constexpr std::size_t kPoints = 60;
constexpr double kNextToTheHorizon = 89.999;  // degrees

std::vector<Point> random_points(Distribution distribution, std::uint64_t offset) {
  std::vector<Point> points = Random(kSeed + offset).points({distribution, Masking::kVCavity}, kPoints);
  for (Point& point : points) {
    if (point.theta_deg < 90.0) point.theta_deg = std::min(point.theta_deg, kNextToTheHorizon);
  }
  return points;
}

using Setting = std::tuple<Kernel, Distribution>;

class GrooveProperties : public testing::TestWithParam<Setting> {};

TEST_P(GrooveProperties, AlbedoIsOne_AndNothingIsLost) {
  const auto [kernel, distribution] = GetParam();
  const double rounding = is_double(kernel) ? 1e-12 : 2e-6;
  const std::vector<Point> points = random_points(distribution, static_cast<std::uint64_t>(distribution));
  for (const double tolerance : tolerances_of(kernel)) {
    const auto moments = make_evaluator(kernel)->evaluate(all_bounces(distribution, points, tolerance), {});
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Moments& m = moments[i];
      const double c = cos_sin_deg(points[i].theta_deg).cos;
      const std::string where = text_of(points[i]);
      EXPECT_NEAR(m.albedo, c, rounding * c) << where;
      EXPECT_NEAR(m.r_i + m.deficit, c, std::min(rounding * c, m.r_i_error + m.deficit_error)) << where;
      EXPECT_GE(m.r_i, 0.0) << where;
      EXPECT_LE(m.r_i, (1.0 + rounding) * c) << where;
      EXPECT_GE(m.deficit, 0.0) << where;
      EXPECT_LE(std::abs(m.r_q), (1.0 + rounding) * m.r_i) << where;
      for (const auto& [value, error] : kMomentMembers) {
        if (value == &Moments::direct_i || value == &Moments::direct_q) continue;
        EXPECT_GE(m.*error, 0.0) << where;
      }
    }
  }
}

std::string setting_name(const testing::TestParamInfo<Setting>& test) {
  const bool is_cauchy = std::get<1>(test.param) == Distribution::kCauchy;
  return name_of(std::get<0>(test.param)) + (is_cauchy ? "Cauchy" : "Gaussian");
}

INSTANTIATE_TEST_SUITE_P(Kernels, GrooveProperties,
                         testing::Combine(testing::ValuesIn(kKernels),
                                          testing::Values(Distribution::kCauchy, Distribution::kGaussian)),
                         setting_name);

// ---- Scenes --------------------------------------------------------------------------------------------------------

SceneValues scene_of(Distribution distribution, const std::vector<std::string>& more = {}) {
  constexpr const char* kScene = R"(
[surface]
n = 1.5
sigma = 0.3
masking = "v-cavity"
scattering = "multiple"
[emission]
temperature_K = 300
[spectrum]
wavelength_um = 10
)";
  std::vector<std::string> overrides = {std::string("surface.distribution=") + name_of(distribution)};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return parse_scene(kScene, "s.toml", settings_from_text(overrides));
}

PointResult result_at(const SceneValues& scene, const Point& point) {
  CpuEvaluator evaluator(Precision::kAuto);
  return evaluate_scene(scene, {{point.theta_deg, point.shape, point.index}}, evaluator, {}).front();
}

TEST(GrooveScenes, RandomEntriesUpToTheHorizon_ArePhysical) {
  constexpr double kRounding = 1e-6;
  for (const Distribution distribution : {Distribution::kCauchy, Distribution::kGaussian}) {
    std::vector<Point> points = random_points(distribution, 10 + static_cast<std::uint64_t>(distribution));
    for (std::size_t i = 0; i < points.size(); i += 6) points[i].theta_deg = i % 12 == 0 ? 90.0 : kNextToTheHorizon;
    for (const char* surroundings : {"surroundings=none", "surroundings.temperature_K=400"}) {
      const SceneValues scene = scene_of(distribution, {surroundings, "accuracy.tolerance=1e-2"});
      for (const Point& point : points) {
        const PointResult r = result_at(scene, point);
        const std::string where = text_of(point);
        EXPECT_EQ(r.status & (kReflectanceOutsideZeroToOne | kIntensityNotPositive | kOutsideModelDomain), 0U) << where;
        EXPECT_NEAR(r[Quantity::kAlbedo], 1.0, kRounding) << where;
        EXPECT_TRUE(r[Quantity::kRhoI] >= 0.0 && r[Quantity::kRhoI] <= 1.0 + kRounding)
            << where << " rho_I " << r[Quantity::kRhoI];
        EXPECT_LE(std::abs(r[Quantity::kRhoQ]), r[Quantity::kRhoI] * (1.0 + kRounding)) << where;
        EXPECT_LE(std::abs(r[Quantity::kStokesQ]), r[Quantity::kStokesI]) << where;
        EXPECT_GT(r[Quantity::kStokesI], 0.0) << where;
        for (const double emissivity : {r[Quantity::kEmissivityS], r[Quantity::kEmissivityP]}) {
          EXPECT_TRUE(emissivity >= -kRounding && emissivity <= 1.0 + kRounding) << where << " eps " << emissivity;
        }
        EXPECT_NEAR(0.5 * (r[Quantity::kEmissivityS] + r[Quantity::kEmissivityP]) + r[Quantity::kRhoI], 1.0, kRounding)
            << where;
      }
    }
  }
}

// rho at 90 degrees is the limit of the stored value 1e-9 degrees before it.
TEST(GrooveScenes, RightAngle_IsTheLimitOfTheStoredValue) {
  constexpr double kApproach = 1e-7;
  for (const StoredCase& c : stored_cases()) {
    if (!c.name.starts_with("grazing-limit")) continue;
    const PointResult at_90 = result_at(scene_of(c.distribution), {90.0, c.shape, c.index});
    const double rho_i = c.moments.r_i / cos_sin_deg(c.theta_deg).cos;
    const double rho_q = c.moments.r_q / cos_sin_deg(c.theta_deg).cos;
    EXPECT_NEAR(at_90[Quantity::kRhoI], rho_i, (at_90[Quantity::kRhoErrorEstimate] + kApproach) * rho_i) << c.name;
    EXPECT_NEAR(at_90[Quantity::kRhoQ], rho_q, (at_90[Quantity::kRhoErrorEstimate] + kApproach) * rho_i) << c.name;
  }
}

TEST(GrooveScenes, SigmaToZero_IsTheSmoothSurface) {
  constexpr double kApproach = 1e-6;  // 1/cos^2 times the variance of the slopes, 2e-10
  const SceneValues multiple = scene_of(Distribution::kGaussian);
  const SceneValues single = scene_of(Distribution::kGaussian, {"surface.scattering=single"});
  for (const double theta_deg : {0.0, 60.0, 85.0}) {
    for (const OpticalConstants index : {OpticalConstants{1.5, 0.0}, {10.0, 60.0}, {0.7, 0.0}}) {
      const PointResult smooth = result_at(multiple, {theta_deg, {0.0, 2.0}, index});
      const PointResult by_single = result_at(single, {theta_deg, {0.0, 2.0}, index});
      EXPECT_EQ(smooth[Quantity::kRhoI], by_single[Quantity::kRhoI]);
      EXPECT_EQ(smooth[Quantity::kRhoQ], by_single[Quantity::kRhoQ]);
      const PointResult rough = result_at(multiple, {theta_deg, {1e-5, 2.0}, index});
      const double allowed = rough[Quantity::kRhoErrorEstimate] * rough[Quantity::kRhoI] + kApproach;
      EXPECT_NEAR(rough[Quantity::kRhoI], smooth[Quantity::kRhoI], allowed) << theta_deg << " " << index.n;
      EXPECT_NEAR(rough[Quantity::kRhoQ], smooth[Quantity::kRhoQ], allowed) << theta_deg << " " << index.n;
      if (smooth[Quantity::kRhoI] == 1.0) continue;  // total reflection: nothing is emitted
      EXPECT_NEAR(rough[Quantity::kDolp], smooth[Quantity::kDolp],
                  rough[Quantity::kErrorEstimate] + smooth[Quantity::kErrorEstimate] + 100.0 * kApproach)
          << theta_deg << " " << index.n;
    }
  }
}

}  // namespace
}  // namespace dolp
