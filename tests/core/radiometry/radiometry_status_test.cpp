// Error estimates and status bits of the radiometry, and its limits at 90 degrees.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

#include <dolp/quantity.hpp>
#include <dolp/status.hpp>
#include "radiometry_support.hpp"

namespace radiometry_status_test {

using namespace radiometry_support;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// ---- Error estimates and status -------------------------------------------------------------------------------------

TEST(Radiometry, MomentsOffByTheirErrors_StayWithinTheEstimates) {
  RandomScenes random;
  std::cout << "seed " << kSeed << "\n";
  for (int i = 0; i < kRandomScenes; ++i) {
    const SceneValues scene = random.next();
    const Direction direction = direction_of(random.uniform(0.0, 89.0));
    const Moments exact = moments_of(random.reflectance(), direction.cos_theta);
    const double level = std::pow(10.0, random.uniform(-12.0, -1.0)) * direction.cos_theta;
    Moments off = exact;
    off.r_i_error = level * random.uniform(0.0, 1.0);
    off.r_q_error = level * random.uniform(0.0, 1.0);
    off.deficit_error = level * random.uniform(0.0, 1.0);
    off.r_i += off.r_i_error * random.uniform(-1.0, 1.0);
    off.r_q += off.r_q_error * random.uniform(-1.0, 1.0);
    off.deficit += random.coin() ? exact.r_i - off.r_i : off.deficit_error * random.uniform(-1.0, 1.0);
    off.deficit_error = std::max(off.deficit_error, std::abs(off.deficit - exact.deficit));
    const PointResult truth = evaluate(scene, direction, exact);
    const PointResult result = evaluate(scene, direction, off);
    if (truth[Quantity::kStokesI] == 0.0) continue;  // without radiation DOLP is undefined
    ASSERT_LE(std::abs(result[Quantity::kDolp] - truth[Quantity::kDolp]), result[Quantity::kErrorEstimate])
        << "scene " << i;
    const double rho_error = std::max(std::abs(result[Quantity::kRhoI] - truth[Quantity::kRhoI]),
                                      std::abs(result[Quantity::kRhoQ] - truth[Quantity::kRhoQ]));
    ASSERT_LE(rho_error, result[Quantity::kRhoErrorEstimate] * truth[Quantity::kRhoI]) << "scene " << i;
  }
}

TEST(Radiometry, ErrorOfTheDeficit_CancelsInIsothermalIntensityWhereItCannotMatter) {
  SceneValues scene = night_scene();
  scene.surface.diffuse = 0.0;
  const Direction direction = direction_of(60.0);
  Moments moments = moments_of({0.3, 0.1}, direction.cos_theta);
  moments.r_q_error = 0.0;
  moments.r_i_error = moments.deficit_error = 1e-4;
  const PointResult cold = evaluate(scene, direction, moments);
  scene.surroundings->temperature_K = 289.0;
  const PointResult warm = evaluate(scene, direction, moments);
  // I = pi B + (X - pi B) rho_I and Q = (X - pi B) rho_Q. A black body as warm as the surface emits pi B. The
  // surroundings, which are 50 K or 1 K colder, emit X. So an error of rho_I changes Q / I about in proportion to
  // (X - pi B)^2, which is far smaller with 1 K.
  EXPECT_LT(warm[Quantity::kErrorEstimate], 1e-3 * cold[Quantity::kErrorEstimate]);
}

TEST(Radiometry, MomentsWithinTolerance_CarryNoStatusAndBeyondItTheBitOfWhatMisses) {
  const SceneValues scene = night_scene();
  const Direction direction = direction_of(60.0);
  Moments moments = moments_of({0.3, 0.1}, direction.cos_theta);
  moments.r_q_error = 0.5 * scene.accuracy.tolerance * moments.r_i;
  EXPECT_EQ(evaluate(scene, direction, moments).status, 0u);
  moments.r_q_error = 2.0 * scene.accuracy.tolerance * moments.r_i;
  EXPECT_EQ(evaluate(scene, direction, moments).status, kRhoToleranceNotMet);
  moments.r_q_error = 20.0 * scene.accuracy.tolerance * moments.r_i;
  EXPECT_EQ(evaluate(scene, direction, moments).status, kToleranceNotMet | kRhoToleranceNotMet);
}

TEST(Radiometry, ReflectanceAboveOneOrBelowZero_CarriesBitOneUnlessWithinItsError) {
  const SceneValues scene = night_scene();
  const Direction direction = direction_of(80.0);
  for (const PrintedReflectance& specular : {PrintedReflectance{1.2L, 0.3L}, {0.3L, 1.2L}, {0.3L, -0.1L}}) {
    Moments moments = moments_of(specular, direction.cos_theta);
    EXPECT_EQ(evaluate(scene, direction, moments).status, kReflectanceOutsideZeroToOne);
    moments.r_i_error = moments.r_q_error = moments.deficit_error = 0.3 * direction.cos_theta;
    EXPECT_EQ(evaluate(scene, direction, moments).status, kToleranceNotMet | kRhoToleranceNotMet);
  }
}

TEST(Radiometry, NegativeIntensity_CarriesBitEightAndKeepsItsNumbers) {
  SceneValues scene = night_scene();
  scene.surroundings.reset();
  const Direction direction = direction_of(89.0);
  const PointResult result = evaluate(scene, direction, moments_of({2.0, 1.5}, direction.cos_theta));
  EXPECT_LT(result[Quantity::kStokesI], 0.0);
  EXPECT_DOUBLE_EQ(result[Quantity::kDolp], std::abs(result[Quantity::kStokesQ]) / result[Quantity::kStokesI]);
  EXPECT_EQ(result.status, kReflectanceOutsideZeroToOne | kIntensityNotPositive);
}

TEST(Radiometry, NoRadiation_HasNoDolpAndSaysSo) {
  SceneValues scene = night_scene();
  scene.emission.reset();
  scene.surroundings->temperature_K = 0.0;
  const Direction direction = direction_of(30.0);
  const PointResult result = evaluate(scene, direction, moments_of({0.3, 0.1}, direction.cos_theta));
  EXPECT_TRUE(std::isnan(result[Quantity::kDolp]));
  EXPECT_EQ(result.status, kOutsideModelDomain | kIntensityNotPositive);
  EXPECT_GT(result[Quantity::kRhoI], 0.0);
  Moments uncertain = moments_of({0.3, 0.1}, direction.cos_theta);
  uncertain.r_i_error = 0.1;
  EXPECT_EQ(evaluate(scene, direction, uncertain).status,
            kOutsideModelDomain | kIntensityNotPositive | kRhoToleranceNotMet);
}

// Planck's function is 0 in double at 1 K and 10 um.
TEST(Radiometry, EmissionOfZero_LeavesTheSourceAndTheEmissivity) {
  SceneValues scene = night_scene();
  scene.surface.specular = 1.0;
  scene.surface.diffuse = 0.0;
  scene.surroundings.reset();
  scene.path.reset();
  scene.source = Source{};
  scene.source->irradiance = 2.0;
  scene.emission->temperature_K = 1.0;
  const Direction direction = direction_of(30.0);
  for (const EmissionModel model : {EmissionModel::kMoments, EmissionModel::kFresnel, EmissionModel::kDirect}) {
    scene.emission->model = model;
    Moments moments = moments_of({0.3, 0.1}, direction.cos_theta);
    moments.direct_i = 0.6 * direction.cos_theta;
    moments.direct_q = 0.2 * direction.cos_theta;
    const PointResult result = evaluate(scene, direction, moments);
    EXPECT_NEAR(result[Quantity::kDolp], 0.5, 1e-14);  // rho_s = 0.3, rho_p = 0.1
    EXPECT_GT(result[Quantity::kEmissivityS], 0.0);
    if (model == EmissionModel::kDirect) {
      EXPECT_NEAR(result[Quantity::kEmissivityS], 0.8, 1e-14);
    }
    EXPECT_EQ(result.status & kNoDolpPromised, 0U);
  }
}

TEST(Radiometry, MomentsThatAreNotNumbers_MissTheToleranceSoThatTheyAreComputedAgain) {
  for (double Moments::*const member : {&Moments::r_i, &Moments::r_q, &Moments::deficit, &Moments::direct_q}) {
    SceneValues scene = night_scene();
    scene.emission->has_bracket = true;
    Moments moments = moments_of({0.3, 0.1}, 0.5);
    moments.direct_i = moments.direct_q = 0.1;
    EXPECT_EQ(evaluate(scene, direction_of(60.0), moments).status & kAnyToleranceNotMet, 0U);
    moments.*member = kNan;
    const PointResult result = evaluate(scene, direction_of(60.0), moments);
    for (const Quantity quantity : {Quantity::kDolp, Quantity::kStokesI, Quantity::kStokesQ, Quantity::kStokesU,
                                    Quantity::kStokesV, Quantity::kRhoI, Quantity::kRhoQ, Quantity::kAlbedo})
      EXPECT_TRUE(std::isnan(result[quantity])) << describe(quantity).name;
    EXPECT_EQ(result[Quantity::kErrorEstimate], kInfinity);
    EXPECT_EQ(result[Quantity::kRhoErrorEstimate], kInfinity);
    EXPECT_EQ(result.status, kToleranceNotMet | kRhoToleranceNotMet);
  }
}

TEST(Radiometry, UnknownBoundOfQ_IsInfinite) {
  Moments moments = moments_of({0.3, 0.1}, 0.5);
  moments.r_q_error = kNan;
  const PointResult result = evaluate(night_scene(), direction_of(60.0), moments);
  EXPECT_EQ(result[Quantity::kErrorEstimate], kInfinity);
  EXPECT_NE(result.status & kToleranceNotMet, 0U);
}

TEST(Radiometry, MatchedIndex_ReflectsNothingWithNoError) {
  SceneValues scene = night_scene();
  scene.surface.diffuse = 0.0;
  const Direction direction = direction_of(60.0);
  const PointResult result = evaluate(scene, direction, moments_of({0.0L, 0.0L}, direction.cos_theta));
  EXPECT_EQ(result[Quantity::kRhoI], 0.0);
  EXPECT_EQ(result[Quantity::kRhoErrorEstimate], 0.0);
  EXPECT_EQ(result[Quantity::kDolp], 0.0);
  EXPECT_EQ(result.status, 0u);
}

TEST(Radiometry, UnboundedReflectanceError_IsInfiniteNotNanInBothEstimates) {
  Moments moments = moments_of({0.3, 0.1}, 0.5);
  moments.r_i_error = moments.deficit_error = moments.r_q_error = 10.0;
  SceneValues scene = night_scene();
  const PointResult result = evaluate(scene, direction_of(60.0), moments);
  EXPECT_EQ(result[Quantity::kErrorEstimate], kInfinity);
  EXPECT_EQ(result[Quantity::kRhoErrorEstimate], kInfinity);
  EXPECT_EQ(result.status, kToleranceNotMet | kRhoToleranceNotMet);
}

// ---- 90 degrees -----------------------------------------------------------------------------------------------------

constexpr std::uint32_t kDivergent = kReflectanceOutsideZeroToOne | kOutsideModelDomain;

Moments grazing_moments() { return {.r_i = 0.08, .r_q = -0.02, .albedo = 0.1, .deficit = -0.08}; }

TEST(Radiometry, GrazingWithDivergingReflectance_GivesTheLimitOfDolp) {
  SceneValues scene = night_scene();
  scene.surface.masking = Masking::kIntegral;
  const PointResult limit = evaluate(scene, {90.0, 0.0}, grazing_moments());
  EXPECT_EQ(limit.status, kDivergent);
  EXPECT_DOUBLE_EQ(limit[Quantity::kDolp], 0.25);
  EXPECT_TRUE(std::isnan(limit[Quantity::kRhoI]) && std::isnan(limit[Quantity::kStokesI]) &&
              std::isnan(limit[Quantity::kStokesU]));
  const PointResult near_limit = evaluate(scene, {89.9999, 1e-14}, grazing_moments());
  // Toward 90 degrees the specular part grows as 1 / cos(theta), and the diffuse part only as cos(theta)^-0.3. So here
  // the diffuse part hardly changes DOLP.
  EXPECT_NEAR(std::abs(near_limit[Quantity::kDolp]), limit[Quantity::kDolp], 1e-8);
}

TEST(Radiometry, GrazingWithSourceOnly_HasAFiniteLimitOfTheFluxes) {
  SceneValues isothermal = night_scene();
  isothermal.surface.masking = Masking::kNone;
  isothermal.surroundings->temperature_K = isothermal.emission->temperature_K;
  EXPECT_EQ(evaluate(isothermal, {90.0, 0.0}, grazing_moments())[Quantity::kDolp], 0.0);
  isothermal.path = Path{0.5, std::nullopt, 1.0};
  SceneValues fresnel = night_scene();
  fresnel.surface.masking = Masking::kNone;
  fresnel.surface.diffuse = 0.0;
  fresnel.surroundings.reset();
  fresnel.emission->model = EmissionModel::kFresnel;
  for (auto& [scene, cos_theta] : {std::pair(&isothermal, 1e-30), {&fresnel, 1e-14}}) {
    scene->source = Source{};
    scene->source->irradiance = 100.0;
    const PointResult limit = evaluate(*scene, {90.0, 0.0}, grazing_moments());
    const PointResult near_limit = evaluate(*scene, {89.9999, cos_theta}, grazing_moments());
    EXPECT_GT(limit[Quantity::kDolp], 0.0);
    EXPECT_NEAR(near_limit[Quantity::kDolp], limit[Quantity::kDolp], kAgreement);
  }
}

TEST(Radiometry, GrazingSmithWithDiffusePart_IsUnpolarisedInTheLimit) {
  const double cos_theta = 1e-18;
  const PointResult limit = evaluate(night_scene(), {90.0, cos_theta}, moments_of({0.5, 0.2}, cos_theta));
  EXPECT_EQ(limit.status, kDivergent);
  EXPECT_EQ(limit[Quantity::kDolp], 0.0);
  EXPECT_DOUBLE_EQ(limit[Quantity::kAlbedo], 1.0);
}

TEST(Radiometry, GrazingSmithWithIsothermalFresnelEmissionOrACosineOfZero_ClaimsNoLimit) {
  SceneValues isothermal = night_scene();
  isothermal.emission->model = EmissionModel::kFresnel;
  isothermal.surroundings->temperature_K = isothermal.emission->temperature_K;
  SceneValues specular = night_scene();
  specular.surface.diffuse = 0.0;
  for (const auto& [scene, cos_theta] : {std::pair(isothermal, 1e-18), {specular, 0.0}}) {
    const PointResult limit = evaluate(scene, {90.0, cos_theta}, moments_of({0.5, 0.2}, cos_theta));
    EXPECT_EQ(limit.status, kDivergent);
    EXPECT_TRUE(std::isnan(limit[Quantity::kDolp]));
  }
}

TEST(Radiometry, GrazingWithFiniteReflectance_UsesTheFormulasAtATinyCosine) {
  SceneValues scene = night_scene();
  const double cos_theta = 1e-18;
  const Moments moments = moments_of({0.5, 0.2}, cos_theta);
  scene.surface.diffuse = 0.0;
  scene.surface.specular = 1.0;
  const PointResult smith = evaluate(scene, {90.0, cos_theta}, moments);
  EXPECT_DOUBLE_EQ(smith[Quantity::kRhoI], 0.35);
  EXPECT_DOUBLE_EQ(smith[Quantity::kRhoQ], 0.15);
  EXPECT_EQ(smith.status, 0u);
  scene.surface.masking = Masking::kIntegral;  // without effect, because sigma = 0 makes the surface a mirror
  EXPECT_EQ(evaluate(scene, {90.0, cos_theta}, moments_of({1.0, 1.0}, cos_theta)).status, 0u);
  scene.surface.diffuse = 0.1;
  scene.surface.diffuse_exponent = 0.0;  // such a diffuse part is finite at 90 degrees
  EXPECT_DOUBLE_EQ(evaluate(scene, {90.0, cos_theta}, moments)[Quantity::kRhoI], 0.45);
}

TEST(Radiometry, GrazingExponentNearMinusOne_StaysFiniteBelowNinetyDegrees) {
  SceneValues scene = night_scene();
  scene.surface.diffuse = 1.0;
  scene.surface.diffuse_exponent = -1.0 + 1e-9;
  const Direction direction = direction_of(89.999999);
  const PointResult result = evaluate(scene, direction, moments_of({0.9, 0.8}, direction.cos_theta));
  EXPECT_TRUE(std::isfinite(result[Quantity::kStokesI]) && std::isfinite(result[Quantity::kDolp]) &&
              std::isfinite(result[Quantity::kRhoI]));
  EXPECT_EQ(result.status & kReflectanceOutsideZeroToOne, kReflectanceOutsideZeroToOne);
}

}  // namespace radiometry_status_test
