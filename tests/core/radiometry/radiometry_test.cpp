// Stokes parameters, rho and DOLP of the radiometry agree with the paper's printed formulas and obey exact relations.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>
#include <vector>

#include "radiometry_support.hpp"
#include "spectrum/planck.hpp"

namespace radiometry_test {

using namespace radiometry_support;

// ---- Radiometry against the printed formulas ------------------------------------------------------------------------

TEST(Radiometry, RandomScenes_AgreeWithPrintedFormulas) {
  std::cout << "seed " << kSeed << "\n";
  RandomScenes random;
  for (int i = 0; i < kRandomScenes; ++i) {
    const SceneValues scene = random.next();
    const Direction direction = direction_of(random.uniform(0.0, 89.5));
    const PrintedReflectance specular = random.reflectance();
    const PointResult actual = evaluate(scene, direction, moments_of(specular, direction.cos_theta));
    PrintedStokes expected = printed_stokes(scene, scene.spectrum.min_um, direction.cos_theta, specular);
    if (scene.spectrum.is_band()) {
      const std::vector<double> ends = {scene.spectrum.min_um, scene.spectrum.max_um};
      const auto at = [&](Real um) { return printed_stokes(scene, um, direction.cos_theta, specular); };
      expected.i = integral(ends, [&](Real um) { return at(um).i; });
      expected.q = integral(ends, [&](Real um) { return at(um).q; });
    }
    // The terms of I and Q may cancel. So a part of the tolerance is relative to the emission, not to the result.
    const double scale = std::abs(static_cast<double>(expected.i)) + std::abs(static_cast<double>(expected.q));
    const double cancelled = 10.0 * kAgreement * Radiometry(scene).rule().samples[0].emitted;
    ASSERT_NEAR(actual[Quantity::kStokesI], static_cast<double>(expected.i), kAgreement * scale + cancelled)
        << "scene " << i;
    ASSERT_NEAR(actual[Quantity::kStokesQ], static_cast<double>(expected.q), kAgreement * scale + cancelled)
        << "scene " << i;
    ASSERT_EQ(actual[Quantity::kStokesU], 0.0);
    ASSERT_EQ(actual[Quantity::kStokesV], 0.0);
    // With total reflection I is 0: the surface emits nothing, and this scene has no light to reflect.
    if (actual[Quantity::kStokesI] == 0.0) {
      ASSERT_TRUE(std::isnan(actual[Quantity::kDolp]));
      continue;
    }
    const auto expected_dolp = static_cast<double>(std::abs(expected.q) / expected.i);
    // With total reflection the emission is 0. The program gives exactly 0, but 1 - R in the expected value is rounded.
    const double printed_rounding = 16.0 * static_cast<double>(std::numeric_limits<Real>::epsilon()) *
                                    Radiometry(scene).rule().samples[0].emitted / std::abs(actual[Quantity::kStokesI]);
    const double bound =
        actual[Quantity::kErrorEstimate] + printed_rounding + kEpsilon * std::abs(actual[Quantity::kDolp]);
    ASSERT_LE(std::abs(actual[Quantity::kDolp] - expected_dolp), bound);
    ASSERT_LE(std::abs(actual[Quantity::kQOverI] - static_cast<double>(expected.q / expected.i)), bound);
    ASSERT_EQ(actual[Quantity::kAlbedo], 1.0);
  }
}

TEST(Radiometry, TabulatedMaterialBand_AgreesWithPrintedFormulas) {
  SceneValues scene = night_scene();
  scene.surface.material = tabulated_material();
  scene.spectrum = {7.5, 14.5};
  scene.path = Path{0.6, 290.0, std::nullopt};
  for (const EmissionModel model : {EmissionModel::kMoments, EmissionModel::kFresnel}) {
    scene.emission->model = model;
    const Radiometry radiometry(scene);
    for (const double theta_deg : {0.0, 33.0, 60.0, 85.0}) {
      const Direction direction = direction_of(theta_deg);
      const auto specular = [&](const OpticalConstants& index) { return printed_fresnel(index, direction.cos_theta); };
      std::vector<Moments> moments;
      for (const FacetOptics& optics : radiometry.rule().indices())
        moments.push_back(moments_of(specular(optics.index), direction.cos_theta));
      const PointResult actual = radiometry.point(direction, moments);
      const auto at = [&](Real um) {
        const OpticalConstants index = scene.surface.material.at(static_cast<double>(um));
        return printed_stokes(scene, um, direction.cos_theta, specular(index));
      };
      const Real i = integral(corners(scene), [&](Real um) { return at(um).i; });
      const Real q = integral(corners(scene), [&](Real um) { return at(um).q; });
      EXPECT_NEAR(actual[Quantity::kStokesI], static_cast<double>(i), kBandAgreement * static_cast<double>(i));
      EXPECT_NEAR(actual[Quantity::kStokesQ], static_cast<double>(q), kBandAgreement * static_cast<double>(i));
      EXPECT_LE(std::abs(actual[Quantity::kDolp] - static_cast<double>(std::abs(q) / i)),
                actual[Quantity::kErrorEstimate] + kBandAgreement);
    }
  }
}

TEST(Radiometry, IndicesOfThePoint_ReplaceThoseOfTheRule) {
  SceneValues scene = night_scene();
  scene.emission->model = EmissionModel::kFresnel;
  const Direction direction = direction_of(60.0);
  const Moments moments = moments_of({0.3, 0.1}, direction.cos_theta);
  const std::vector<FacetOptics> indices = {{3.0, 0.5}};
  const Radiometry radiometry(scene);
  const PointResult replaced =
      radiometry.point(radiometry.view(direction, radiometry.optics_with(indices)), std::vector<Moments>{moments});
  const PointResult own = evaluate(scene, direction, moments);
  scene.surface.material.constant = indices[0].index;
  const PointResult other = evaluate(scene, direction, moments);
  EXPECT_EQ(replaced[Quantity::kStokesQ], other[Quantity::kStokesQ]);
  EXPECT_NE(replaced[Quantity::kStokesQ], own[Quantity::kStokesQ]);
}

// ---- What must hold exactly -----------------------------------------------------------------------------------------

TEST(Radiometry, IsothermalSurroundingsWithoutSource_HaveNoPolarisation) {
  RandomScenes random;
  for (int i = 0; i < kRandomScenes; ++i) {
    SceneValues scene = random.next();
    scene.source.reset();
    scene.emission = Emission{random.uniform(1.0, 6000.0), EmissionModel::kMoments};
    scene.surroundings = Surroundings{scene.emission->temperature_K};
    const Direction direction = direction_of(random.uniform(0.0, 89.9));
    const PointResult result = evaluate(scene, direction, moments_of(random.reflectance(), direction.cos_theta));
    if (result[Quantity::kStokesI] == 0.0) continue;  // the radiances are too small for a double
    ASSERT_EQ(result[Quantity::kStokesQ], 0.0);
    ASSERT_FALSE(std::signbit(result[Quantity::kStokesQ]));
    ASSERT_EQ(result[Quantity::kDolp], 0.0);
  }
}

TEST(Radiometry, SourceThatCancelsEmission_LeavesNoQ) {
  SceneValues scene = night_scene();
  scene.surroundings.reset();
  const Direction direction = direction_of(60.0);
  scene.source = Source{};
  scene.source->irradiance = std::numbers::pi * planck_radiance(10.6, 290.0) / direction.cos_theta;
  const PointResult result = evaluate(scene, direction, moments_of({0.3, 0.1}, direction.cos_theta));
  EXPECT_LE(result[Quantity::kDolp], 2.0 * kEpsilon);
  EXPECT_LE(result[Quantity::kDolp], result[Quantity::kErrorEstimate]);
}

TEST(Radiometry, ErrorOfTheDirectEmission_IsInTheEstimateWhereTheBracketIs) {
  const Direction direction = direction_of(60.0);
  Moments moments = moments_of({0.3, 0.1}, direction.cos_theta);
  moments.direct_i = 0.7 * direction.cos_theta;
  moments.direct_q = -0.05 * direction.cos_theta;
  moments.direct_q_error = 1e-3 * direction.cos_theta;
  SceneValues scene = night_scene();
  EXPECT_LT(evaluate(scene, direction, moments)[Quantity::kErrorEstimate], 1e-6);
  scene.emission->has_bracket = true;
  const PointResult bounded = evaluate(scene, direction, moments);
  moments.direct_q += moments.direct_q_error;
  const PointResult other = evaluate(scene, direction, moments);
  EXPECT_NE(other[Quantity::kDolpHigh], bounded[Quantity::kDolpHigh]);
  EXPECT_LE(std::abs(other[Quantity::kDolpHigh] - bounded[Quantity::kDolpHigh]),
            bounded[Quantity::kErrorEstimate] * (1.0 + kAgreement));
  EXPECT_LE(std::abs(other[Quantity::kDolpLow] - bounded[Quantity::kDolpLow]),
            bounded[Quantity::kErrorEstimate] * (1.0 + kAgreement));
}

TEST(Radiometry, TemperaturesFromOneTo6000K_GiveFiniteStokes) {
  for (const double temperature_K : {1.0, 3.0, 77.0, 6000.0}) {
    for (const double wavelength_um : {0.3, 10.6, 1000.0}) {
      SceneValues scene = night_scene();
      scene.emission->temperature_K = temperature_K;
      scene.spectrum = {wavelength_um, wavelength_um};
      const Direction direction = direction_of(60.0);
      const PointResult result = evaluate(scene, direction, moments_of({0.3, 0.1}, direction.cos_theta));
      EXPECT_TRUE(std::isfinite(result[Quantity::kStokesI]) && std::isfinite(result[Quantity::kStokesQ]))
          << temperature_K << wavelength_um;
      EXPECT_EQ(std::isfinite(result[Quantity::kDolp]), result[Quantity::kStokesI] > 0.0)
          << temperature_K << " " << wavelength_um;
    }
  }
}

TEST(Radiometry, MetalWithoutSurroundings_KeepsTheDigitsOfItsEmission) {
  SceneValues scene = night_scene();
  scene.surface.specular = 1.0;
  scene.surface.diffuse = 0.0;
  scene.surroundings.reset();
  const Direction direction = direction_of(0.0);
  Moments moments;
  moments.deficit = 3e-12;  // so small that 1 - r_i has only four correct digits
  moments.r_i = 1.0 - moments.deficit;
  moments.r_q = 1e-12;
  const PointResult result = evaluate(scene, direction, moments);
  EXPECT_NEAR(result[Quantity::kDolp], 1.0 / 3.0, kAgreement);
}

}  // namespace radiometry_test
