// Planck's law, the absorptance of a smooth surface, and the spectral rule, compared with independent values.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "model/smooth_surface.hpp"
#include "radiometry_support.hpp"
#include "scene/csv.hpp"
#include "spectrum/planck.hpp"
#include "spectrum/spectral_rule.hpp"
#include "temporary_file.hpp"

namespace spectral_rule_test {

using namespace radiometry_support;

// ---- Planck's function and the smooth surface -----------------------------------------------------------------------

/// The rows of a file that data/make_radiometry_values.py has written.
std::vector<std::vector<double>> stored_rows(const std::string& name) {
  const std::string text = read_file(DOLP_TEST_DATA_DIR "/" + name);
  std::vector<std::vector<double>> rows;
  CsvReader row(text, name);
  row.next();  // the names of the columns
  while (row.next()) {
    rows.emplace_back();
    for (std::size_t i = 0; i < row.cells().size(); ++i) rows.back().push_back(row.number(i, name));
  }
  return rows;
}

TEST(Planck, FiftyDigitValues_Agree) {
  const std::vector<std::vector<double>> rows = stored_rows("planck.csv");
  ASSERT_EQ(rows.size(), 49U);
  for (const std::vector<double>& row : rows) {
    const double um = row.at(0), kelvin = row.at(1), radiance = row.at(2);
    // The exponential amplifies the rounding error of its exponent hc/(lambda k T).
    const double tolerance = (6.0 + 2.0 * 14388.0 / (um * kelvin)) * kEpsilon;
    EXPECT_NEAR(planck_radiance(um, kelvin), radiance, tolerance * radiance) << um << " um, " << kelvin << " K";
  }
}

TEST(SmoothAbsorptance, FiftyDigitValues_Agree) {
  // About ten roundings without cancellation: a complex product, square root and quotient.
  constexpr double kTolerance = 20.0 * kEpsilon;
  const std::vector<std::vector<double>> rows = stored_rows("smooth_absorptance.csv");
  ASSERT_EQ(rows.size(), 60U);
  for (const std::vector<double>& row : rows) {
    const double n = row.at(0), k = row.at(1), cosine = row.at(2), s = row.at(3), p = row.at(4);
    const SmoothAbsorptance actual = smooth_absorptance({n, k}, cosine);
    EXPECT_NEAR(actual.s, s, kTolerance * s) << n << " " << k << " " << cosine;
    EXPECT_NEAR(actual.p, p, kTolerance * p) << n << " " << k << " " << cosine;
  }
}

// ---- Spectral rule --------------------------------------------------------------------------------------------------

TEST(SpectralRule, ConstantIndexBands_IntegratePlanckToRounding) {
  // The case of 1 K over the widest band is the hardest. There the exponent in Planck's law varies most, and only the
  // longest wavelengths contribute to the integral.
  for (const double temperature_K : {1.0, 20.0, 77.0, 300.0, 6000.0}) {
    for (const auto& [from_um, to_um] : {std::pair{0.3, 1000.0}, {8.0, 14.0}, {3.0, 5.0}}) {
      SceneValues scene = night_scene();
      scene.emission->temperature_K = temperature_K;
      scene.spectrum = {from_um, to_um};
      const SpectralRule rule = spectral_rule(scene);
      ASSERT_EQ(rule.samples.size(), 1u);
      // As a function of ln(lambda) the integrand is smooth over the whole band.
      const std::vector<double> ends = {std::log(from_um), std::log(to_um)};
      const Real expected = integral(ends, [&](Real x) {
        return std::numbers::pi_v<Real> * std::exp(x) * printed_planck(std::exp(x), temperature_K);
      });
      EXPECT_NEAR(rule.samples[0].emitted, static_cast<double>(expected), 1e-12 * static_cast<double>(expected))
          << temperature_K << " K, " << from_um << " um";
      EXPECT_NEAR(rule.samples[0].width, to_um - from_um, 1e-13 * to_um);
    }
  }
}

TEST(SpectralRule, EqualTemperatures_HaveNoExcessAtAnySample) {
  SceneValues scene = night_scene();
  scene.surface.material = tabulated_material();
  scene.surroundings->temperature_K = scene.emission->temperature_K;
  scene.spectrum = {8.0, 14.0};
  for (const SpectralSample& sample : spectral_rule(scene).samples) EXPECT_EQ(sample.excess, 0.0);
}

TEST(SpectralRule, FlatMaterialSegments_ShareOneSample) {
  SceneValues scene = night_scene();
  scene.surface.material.n = {{7.0, 10.0, 15.0}, {1.5, 1.5, 1.5}, SpectralTable::Interpolation::kLinear};
  scene.surface.material.k = {{7.0, 9.0, 15.0}, {0.1, 0.1, 0.1}, SpectralTable::Interpolation::kLinear};
  scene.spectrum = {8.0, 14.0};
  EXPECT_EQ(spectral_rule(scene).samples.size(), 1u);
}

void expect_promised_reflectances(const Material& material) {
  SceneValues scene = night_scene();
  scene.surface.material = material;
  scene.spectrum = {7.5, 14.5};
  scene.source = Source{};
  scene.source->table = std::make_shared<SpectralTable>(
      SpectralTable{{5.0, 8.1, 9.3, 10.0, 20.0}, {9.0, 4.0, 6.0, 0.5, 0.1}, SpectralTable::Interpolation::kLogLog});
  const SpectralRule rule = spectral_rule(scene);
  EXPECT_LE(rule.relative_error, kBandAgreement);
  for (const Real cosine : {0.97L, 0.7L, 0.3L, 0.15L}) {  // other cosines than those by which the rule is chosen
    Real actual_emitted = 0.0L;
    Real actual_direct = 0.0L;
    for (const SpectralSample& sample : rule.samples) {
      const PrintedReflectance r = printed_fresnel(sample.index.index, cosine);
      actual_emitted += sample.emitted * r.s;
      actual_direct += sample.irradiance * r.p;
    }
    const auto reflectance = [&](Real at) {
      return printed_fresnel(scene.surface.material.at(static_cast<double>(at)), cosine);
    };
    const Real emitted = integral(corners(scene), [&](Real at) {
      return std::numbers::pi_v<Real> * printed_planck(at, 290.0L) * reflectance(at).s;
    });
    const Real direct = integral(corners(scene), [&](Real at) {
      return static_cast<Real>(scene.source->table->at(static_cast<double>(at))) * reflectance(at).p;
    });
    EXPECT_NEAR(static_cast<double>(actual_emitted / emitted), 1.0, kBandAgreement) << cosine;
    EXPECT_NEAR(static_cast<double>(actual_direct / direct), 1.0, kBandAgreement) << cosine;
  }
}

TEST(SpectralRule, TabulatedMaterialBand_IntegratesReflectancesToItsPromise) {
  expect_promised_reflectances(tabulated_material());
}

TEST(SpectralRule, FormulaMaterialBand_IntegratesReflectancesToItsPromise) {
  Material material = tabulated_material();  // n is replaced in the next line
  material.n = {{7.0, 15.0}, {0.0, 0.0}, SpectralTable::Interpolation::kLinear, {1, {0.0, 4.458, 0.2, 2.896, 47.14}}};
  expect_promised_reflectances(material);
}

}  // namespace spectral_rule_test
