// Bistatic mode, compared with a second implementation of shaders/physics/README.md, section 4. The second one
// is in this test. It takes the pBRDF and the moments from the reference.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>

#include <dolp/status.hpp>
#include "draws.hpp"
#include "properties_support.hpp"
#include "reference/mueller.hpp"
#include "reference/reference_evaluator.hpp"
#include "run/scene_run.hpp"
#include "run/scene_table.hpp"
#include "spectrum/planck.hpp"

namespace dolp::bistatic_test {
namespace {

constexpr std::uint64_t kSeed = 20260212;
constexpr int kScenes = 40;
constexpr double kWavelength_um = 10.6;

class RandomScenes : public Draws {
 public:
  RandomScenes() : Draws(kSeed) {}

  SceneValues scene() {
    SceneValues scene;
    const bool metal = uniform(0.0, 1.0) < 0.3;
    scene.surface.material.constant = metal ? OpticalConstants{uniform(2.0, 27.0), uniform(20.0, 90.0)}
                                            : OpticalConstants{uniform(1.3, 3.0), uniform(0.0, 0.5)};
    scene.surface.distribution = uniform(0.0, 1.0) < 0.5 ? Distribution::kCauchy : Distribution::kGaussian;
    scene.surface.masking = static_cast<Masking>(static_cast<int>(uniform(0.0, 3.999)));
    scene.surface.sigma = uniform(0.1, 0.6);
    scene.surface.q = uniform(1.7, 6.0);
    scene.surface.specular = uniform(0.3, 1.0);
    scene.surface.diffuse = uniform(0.0, 0.3);
    scene.surface.diffuse_exponent = uniform(-0.5, 0.0);
    scene.emission = Emission{uniform(280.0, 320.0), EmissionModel::kMoments};
    scene.source.emplace().irradiance = uniform(0.0, 20.0);
    scene.surroundings = Surroundings{uniform(0.0, 300.0)};
    if (uniform(0.0, 1.0) < 0.5)
      scene.path = Path{.transmittance = uniform(0.3, 1.0), .temperature_K = {}, .radiance = 0.4};
    scene.spectrum = {kWavelength_um, kWavelength_um};
    scene.geometry = {Mode::kBistatic, uniform(5.0, 80.0), uniform(-180.0, 180.0)};
    return scene;
  }
};

struct Radiance {
  double i, q, u, v;
};

Radiance model_radiance(const SceneValues& scene, double theta_i_deg) {
  const Surface& surface = scene.surface;
  MomentsRequest request;
  request.distribution = surface.distribution;
  request.masking = surface.masking;
  request.append({scene.geometry.view_zenith_deg, {surface.sigma, surface.q}, surface.material.constant});
  const Moments moments = ReferenceEvaluator().evaluate(request, {}).front();
  const double cos_i = std::cos(theta_i_deg * std::numbers::pi / 180.0);
  const double cos_v = std::cos(scene.geometry.view_zenith_deg * std::numbers::pi / 180.0);
  const double c = surface.diffuse_exponent;
  const double rho_i = surface.specular * moments.r_i / cos_v + 2.0 * surface.diffuse * std::pow(cos_v, c) / (c + 2.0);
  const double rho_q = surface.specular * moments.r_q / cos_v;
  const double emitted = planck_radiance(kWavelength_um, scene.emission->temperature_K);
  const double surroundings = planck_radiance(kWavelength_um, scene.surroundings->temperature_K);
  const BeamAngles angles{theta_i_deg, scene.geometry.view_zenith_deg, scene.geometry.relative_azimuth_deg};
  const reference::Slopes slopes(surface.distribution, {surface.sigma, surface.q});
  const reference::Mueller f =
      reference::single_bounce(slopes, surface.masking, surface.material.constant, angles) / (cos_i * cos_v);
  const double beam = scene.source->irradiance * cos_i;
  const double diffuse = surface.diffuse / std::numbers::pi * std::pow(cos_i * cos_v, c);
  const double k_s = surface.specular;
  Radiance l = {emitted * (1.0 - rho_i) + surroundings * rho_i + beam * (k_s * f(0, 0) + diffuse),
                -emitted * rho_q + surroundings * rho_q + beam * k_s * f(1, 0), beam * k_s * f(2, 0),
                beam * k_s * f(3, 0)};
  if (scene.path) {
    const double tau = scene.path->transmittance;
    l = {tau * l.i + *scene.path->radiance, tau * l.q, tau * l.u, tau * l.v};
  }
  return l;
}

PointResult result_at(const SceneValues& scene, double theta_i_deg, ModelEvaluator& evaluator) {
  const SlopeShape shape{scene.surface.sigma, scene.surface.q};
  return evaluate_scene(scene, {{theta_i_deg, shape, {}}}, evaluator, {}).front();
}

TEST(Bistatic, RandomScenes_AgreeWithTheModelWrittenOut) {
  std::printf("seed %llu\n", static_cast<unsigned long long>(kSeed));
  RandomScenes random;
  std::vector<std::unique_ptr<ModelEvaluator>> evaluators;
  for (const Kernel kernel : {Kernel::kVulkanFloat, Kernel::kVulkanDouble, Kernel::kCpuDouble})
    evaluators.push_back(make_evaluator(kernel));
  evaluators.push_back(std::make_unique<ReferenceEvaluator>());
  double worst = 0.0;
  for (int n = 0; n < kScenes; ++n) {
    const SceneValues scene = random.scene();
    const double theta_i_deg = random.uniform(1.0, 85.0);
    const Radiance l = model_radiance(scene, theta_i_deg);
    for (std::size_t i = 0; i < evaluators.size(); ++i) {
      SCOPED_TRACE(fmt::format("scene {}, evaluator {}", n, i));
      const PointResult r = result_at(scene, theta_i_deg, *evaluators[i]);
      // The stated error of DOLP also bounds the errors of Q/I and U/I. Here Q and U are divided by the exact I instead
      // of the computed I. The factor 2 allows for the difference.
      const double bound = 2.0 * r[Quantity::kErrorEstimate] + 1e-9;
      EXPECT_NEAR(r[Quantity::kStokesQ] / l.i, l.q / l.i, bound);
      EXPECT_NEAR(r[Quantity::kStokesU] / l.i, l.u / l.i, bound);
      EXPECT_NEAR(r[Quantity::kStokesV] / l.i, l.v / l.i, bound);
      EXPECT_NEAR(r[Quantity::kStokesI] / l.i, 1.0, 2.0 * scene.accuracy.tolerance);
      EXPECT_NEAR(r[Quantity::kDolp], std::hypot(l.q, l.u) / l.i, r[Quantity::kErrorEstimate] + 1e-9);
      if (promises_dolp(r.status)) {
        EXPECT_LE(r[Quantity::kErrorEstimate], scene.accuracy.tolerance);
      }
      worst = std::max(worst, std::abs(r[Quantity::kDolp] - std::hypot(l.q, l.u) / l.i));
    }
  }
  std::printf("worst DOLP difference %.1e\n", worst);
}

/// States that the error of a beam is 1 % of its first matrix element.
class BiasedBeams final : public ModelEvaluator {
 public:
  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override {
    return own_.evaluate(request, progress);
  }
  std::vector<ScatteringMatrix> scatter(const ScatteringRequest& request, const Progress& progress) override {
    std::vector<ScatteringMatrix> matrices = own_.scatter(request, progress);
    for (ScatteringMatrix& f : matrices) f.error = 1e-2 * f.m[0];
    return matrices;
  }
  EvaluationReport report() const override { return own_.report(); }

 private:
  CpuEvaluator own_;
};

TEST(Bistatic, BeamWithALargeError_IsInTheStatedError) {
  RandomScenes random;
  SceneValues scene = random.scene();
  scene.source->irradiance = 20.0;
  const double theta_deg = scene.geometry.view_zenith_deg;
  scene.geometry.relative_azimuth_deg = 180.0;
  CpuEvaluator usual;
  EXPECT_LE(result_at(scene, theta_deg, usual)[Quantity::kErrorEstimate], scene.accuracy.tolerance);
  BiasedBeams biased;
  const PointResult wrong = result_at(scene, theta_deg, biased);
  EXPECT_GT(wrong[Quantity::kErrorEstimate], scene.accuracy.tolerance);
  EXPECT_NE(wrong.status & kToleranceNotMet, 0U);
}

TEST(Bistatic, Mirror_HasNoBeamButInItsSpecularDirection) {
  RandomScenes random;
  SceneValues scene = random.scene();
  scene.surface.diffuse = 0.0;
  scene.surface.sigma = 0.0;
  FixedPrecision evaluator(Precision::kDouble);
  const auto dolp_at = [&](double theta_i_deg, double view_deg, double azimuth_deg) {
    scene.geometry = {Mode::kBistatic, view_deg, azimuth_deg};
    return result_at(scene, theta_i_deg, evaluator)[Quantity::kDolp];
  };
  EXPECT_TRUE(std::isnan(dolp_at(40.0, 40.0, 180.0)));
  EXPECT_TRUE(std::isnan(dolp_at(0.0, 0.0, 70.0)));
  EXPECT_TRUE(std::isfinite(dolp_at(40.0, 40.0, 179.0)));
  EXPECT_TRUE(std::isfinite(dolp_at(40.0, 41.0, 180.0)));
}

TEST(Bistatic, BothBeamsAtNinetyDegrees_AreOutsideTheDomain) {
  RandomScenes random;
  SceneValues scene = random.scene();
  scene.surface.diffuse = 0.0;
  scene.geometry.view_zenith_deg = 90.0;
  FixedPrecision evaluator(Precision::kFloat);
  for (const Masking masking : {Masking::kNone, Masking::kIntegral}) {
    scene.surface.masking = masking;
    EXPECT_TRUE(std::isnan(result_at(scene, 90.0, evaluator)[Quantity::kDolp]));
  }
}

TEST(Bistatic, OppositeAzimuth_TurnsTheSignOfU) {
  RandomScenes random;
  FixedPrecision evaluator(Precision::kFloat);
  SceneValues scene = random.scene();
  scene.geometry.relative_azimuth_deg = 130.0;
  const PointResult left = result_at(scene, 40.0, evaluator);
  scene.geometry.relative_azimuth_deg = -130.0;
  const PointResult right = result_at(scene, 40.0, evaluator);
  EXPECT_NE(left[Quantity::kStokesU], 0.0);
  EXPECT_EQ(left[Quantity::kStokesU], -right[Quantity::kStokesU]);
  EXPECT_EQ(left[Quantity::kStokesQ], right[Quantity::kStokesQ]);
  EXPECT_EQ(left[Quantity::kDolp], right[Quantity::kDolp]);
}

TEST(Bistatic, SourceAngles_ShareTheMomentsOfTheView) {
  RandomScenes random;
  const SceneValues scene = random.scene();
  FixedPrecision evaluator(Precision::kFloat);
  const SlopeShape shape{scene.surface.sigma, scene.surface.q};
  const std::vector<PointResult> results =
      evaluate_scene(scene, {{0.0, shape, {}}, {30.0, shape, {}}, {90.0, shape, {}}}, evaluator, {});
  const double three = evaluator.report().evaluations;
  result_at(scene, 10.0, evaluator);
  EXPECT_GT(three, 0.0);
  // All entries share the moments of the view direction. So the second run, with one entry, takes as many evaluations
  // as the first run, with three. The report adds up both runs.
  EXPECT_EQ(2.0 * three, evaluator.report().evaluations);
  EXPECT_EQ(results[0][Quantity::kRhoI], results[2][Quantity::kRhoI]);
  EXPECT_EQ(results[2].status, 0U);  // no status bit, because a source at 90 degrees adds nothing
}

TEST(Bistatic, StokesOfATable_AreRadiances) {
  RandomScenes random;
  SceneValues scene = random.scene();
  const auto units = [&] { return table_layout(scene, keep_everything(scene), scene.grid).head.stokes_units; };
  EXPECT_EQ(units(), "W m-2 sr-1 um-1");
  scene.geometry.mode = Mode::kHemispherical;
  EXPECT_EQ(units(), "W m-2 um-1");
  scene.spectrum.max_um += 1.0;
  EXPECT_EQ(units(), "W m-2");
}

PointResult seen_at(SceneValues scene, double view_zenith_deg) {
  scene.geometry.view_zenith_deg = view_zenith_deg;
  FixedPrecision evaluator(Precision::kDouble);
  return result_at(scene, 60.0, evaluator);
}

TEST(Bistatic, ViewAtNinetyDegrees_IsTheLimitWhereThereIsOne) {
  constexpr double kStep = 1e-5;  // relative change of I in the last 1e-4 degrees
  RandomScenes random;
  for (const Masking masking : {Masking::kVCavity, Masking::kSmith}) {
    SceneValues scene = random.scene();
    scene.surface.masking = masking;
    scene.surface.diffuse = 0.0;
    scene.surface.sigma = 0.3;
    const PointResult at = seen_at(scene, 90.0);
    const PointResult near = seen_at(scene, 90.0 - 1e-4);
    EXPECT_EQ(at.status, 0U);
    EXPECT_NEAR(at[Quantity::kStokesI] / near[Quantity::kStokesI], 1.0, kStep);
    EXPECT_NEAR(at[Quantity::kStokesQ] / near[Quantity::kStokesI], near[Quantity::kStokesQ] / near[Quantity::kStokesI],
                kStep);
    EXPECT_NEAR(at[Quantity::kRhoI], near[Quantity::kRhoI], kStep);
  }
}

TEST(Bistatic, ViewAtNinetyDegreesOfADivergingReflectance_IsOutsideTheDomain) {
  RandomScenes random;
  SceneValues scene = random.scene();
  scene.surface.masking = Masking::kNone;
  const PointResult r = seen_at(scene, 90.0);
  EXPECT_TRUE(std::isnan(r[Quantity::kDolp]));
  EXPECT_EQ(r.status, kReflectanceOutsideZeroToOne | kOutsideModelDomain);
  scene.source.reset();  // without a source, the limit of DOLP is that of the hemispherical mode
  const double bistatic = seen_at(scene, 90.0)[Quantity::kDolp];
  scene.geometry.mode = Mode::kHemispherical;
  FixedPrecision evaluator(Precision::kDouble);
  EXPECT_EQ(bistatic, result_at(scene, 90.0, evaluator)[Quantity::kDolp]);
  EXPECT_GT(bistatic, 0.0);
}

}  // namespace
}  // namespace dolp::bistatic_test
