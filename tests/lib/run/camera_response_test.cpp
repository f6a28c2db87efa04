// Scenes with the response of a camera, and with a diffuse reflectance over the wavelength, compared with sums over
// single wavelengths.
#include <gtest/gtest.h>

#include <cmath>

#include "computed_scene.hpp"
#include "run/table_scene.hpp"
#include "spectrum/spectral_rule.hpp"
#include "temporary_file.hpp"
#include "verify/table_check.hpp"

namespace dolp::camera_response_test {
namespace {

using enum Quantity;

const std::string kSilica = R"toml(
[surface]
material = "SiO2 fused silica"
sigma = 0
q = 3.0
masking = "smith"
[emission]
temperature_K = 300
[surroundings]
temperature_K = 250
[source]
irradiance = 2
[spectrum]
band_um = [8, 14]
[grid]
theta_deg = [60]
)toml";

// Two lobes, a step, and rows at which the response is 0 at both ends and between the lobes.
constexpr const char* kLobes = "7,0\n8,0\n8.5,1\n9.4,0.8\n9.400001,0.3\n10,0\n10.7,0\n11,0.4\n12.6,0.9\n14,0\n14.5,0\n";

/// Sums of I, Q and rho_I over single wavelengths, by the midpoint rule. rho_I is weighted with the incident light.
struct Sums {
  double i = 0.0, q = 0.0, rho = 0.0;
};
constexpr int kSteps = 3000;  // the kinks of response and n, k leave errors below kSumError
constexpr double kSumError = 2e-6;

Sums wavelength_sums(SceneValues scene, const std::function<double(double)>& weight, int steps = kSteps) {
  const Spectrum band = scene.spectrum;
  std::vector<SceneEntry> entries;
  std::vector<SceneVariant> variants;
  for (int step = 0; step < steps; ++step) {
    entries.push_back({60.0, {scene.surface.sigma, scene.surface.q}, {}, static_cast<std::uint32_t>(step)});
    variants.emplace_back().wavelength_um = std::lerp(band.min_um, band.max_um, (step + 0.5) / steps);
  }
  scene.spectrum = {band.min_um, band.min_um};
  Sums sums;
  double all = 0.0;
  const std::vector<PointResult> results = results_of(scene, {entries, variants});
  for (int step = 0; step < steps; ++step) {
    const double width = weight(*variants[step].wavelength_um) * (band.max_um - band.min_um) / steps;
    sums.i += width * results[step][kStokesI];
    sums.q += width * results[step][kStokesQ];
    sums.rho += width * results[step][kRhoI];
    all += width;
  }
  sums.rho /= all;
  return sums;
}

SceneValues silica_with(const std::string& response_path, std::vector<std::string> more = {}) {
  more.push_back("spectrum.response_file=" + response_path);
  return parse(kSilica, more);
}

TEST(CameraResponse, Rectangle_EqualsTheBand) {
  const TemporaryFile file("r.csv", "8,1\n14,1\n");
  for (const char* sigma : {"surface.sigma=0", "surface.sigma=0.2"}) {
    const PointResult band = results_of(parse(kSilica, {sigma})).front();
    const PointResult same = results_of(silica_with(file.path(), {sigma})).front();
    EXPECT_NEAR(same[kStokesI], band[kStokesI], 1e-12 * band[kStokesI]);
    EXPECT_NEAR(same[kDolp], band[kDolp], 1e-12);
    EXPECT_EQ(same.status, band.status);
  }
}

TEST(CameraResponse, StepsLobesAndGaps_AreWeightedSumsOfWavelengths) {
  const TemporaryFile file("r.csv", kLobes);
  for (const char* per : {"power", "photon"}) {
    const SceneValues scene = silica_with(file.path(), {std::string("spectrum.response_per=") + per});
    const SpectralTable rows = *scene.spectrum.response;
    const bool is_photon = per == std::string("photon");
    const Sums expected = wavelength_sums(
        scene, [&](double at_um) { return rows.at(at_um) * (is_photon ? at_um / 8.5 : 1.0); });  // 8.5: the largest row
    const PointResult result = results_of(scene).front();
    EXPECT_NEAR(result[kStokesI] / expected.i, 1.0, kSumError) << per;
    EXPECT_NEAR(result[kQOverI], expected.q / expected.i, kSumError + result[kErrorEstimate]) << per;
    EXPECT_LT(result[kErrorEstimate], 1e-5) << per;
  }
}

TEST(CameraResponse, SmoothCurveOf600Rows_TakesHardlyMoreSamplesThanTheBand) {
  std::string rows;
  for (int i = 0; i < 600; ++i) {
    const double at_um = std::lerp(8.0, 14.0, i / 599.0);
    rows += fmt::format("{},{}\n", at_um, std::pow(std::sin((at_um - 7.0) / 8.0 * std::numbers::pi), 2));
  }
  const TemporaryFile file("r.csv", rows);
  for (const char* surface : {"surface.k=0", "surface.coating=[{ n = 1.5, k = 0.01, thickness_um = 5 }]"}) {
    const SceneValues band = parse(kSilica, {surface == std::string("surface.k=0") ? "surface.q=3" : surface});
    const SceneValues curve = with_settings(band, {{"spectrum.response_file", file.path()}});
    const std::size_t samples = spectral_rule(band).samples.size();
    EXPECT_LE(spectral_rule(curve).samples.size(), samples + samples / 4) << surface;
    const SpectralTable table = *curve.spectrum.response;
    const Sums expected = wavelength_sums(curve, [&](double at_um) { return table.at(at_um); });
    const PointResult result = results_of(curve).front();
    EXPECT_NEAR(result[kQOverI], expected.q / expected.i, kSumError + result[kErrorEstimate]) << surface;
  }
}

TEST(CameraResponse, TableWithoutTheFile_GivesTheSameNumbers) {
  std::optional<TemporaryFile> response(std::in_place, "r.csv", kLobes);
  std::optional<TemporaryFile> diffuse(std::in_place, "d.csv", "wavelength_um,reflectance\n8,0.1\n10,0.3\n14,0.05\n");
  const SceneValues scene =
      silica_with(response->path(), {"spectrum.response_per=photon", "surface.diffuse_file=" + diffuse->path()});
  const TableValues table = table_of(scene);
  response.reset();
  diffuse.reset();
  const SceneValues again = table_scene(table, "t.nc");
  EXPECT_EQ(results_of(again).front()[kDolp], table[kDolp].front());
  EXPECT_EQ(results_of(again).front()[kStokesI], table[kStokesI].front());
}

TEST(CameraResponse, Verify_SeesAWrongWeight) {
  const TemporaryFile file("r.csv", "8,1\n14,0.2\n");
  const SceneValues power = silica_with(file.path());
  const SceneValues photon = silica_with(file.path(), {"spectrum.response_per=photon"});
  for (const SceneValues* computed : {&power, &photon}) {
    TableValues table = table_of(power);
    static_cast<ResultColumns&>(table) = table_of(*computed);
    const TableCheck check = check_table({std::move(table), {0}}, power, "response", {});
    EXPECT_EQ(check.failures.empty(), computed == &power);
  }
}

// Each row: what a surface with a diffuse_file reflects and emits.
TEST(DiffuseFile, Band_IsTheIntegralOfItsWavelengths) {
  const TemporaryFile file("d.csv", "wavelength_um,reflectance\n7,0.1\n8.8,0.6\n9.1,0.05\n11,0.3\n14,0.2\n");
  const std::string diffuse = "surface.diffuse_file=" + file.path();
  const std::vector<std::vector<std::string>> cases = {
      {},
      {"emission.model=fresnel"},
      {"emission=none"},
      {"emission=none", "surroundings=none"},
      {"surroundings.profile=clear-sky"},
      {"surroundings.profile=clear-sky", "emission.model=direct"},
      {"surface.sigma=0.1", "surface.specular=0", "geometry.mode=bistatic", "source.irradiance=50"}};
  for (std::vector<std::string> settings : cases) {
    settings.insert(settings.begin(), {"surface.specular=0.4", diffuse});
    const SceneValues scene = parse(kSilica, settings);
    const std::string name = fmt::format("{}", fmt::join(settings, " "));
    // A sky makes each wavelength slow. With a fifth of the steps, the error of the sums is 25 times as large.
    const bool has_sky = scene.surroundings && scene.surroundings->profile;
    const Sums expected = wavelength_sums(
        scene, [](double) { return 1.0; }, has_sky ? kSteps / 5 : kSteps);
    const double sum_error = has_sky ? 25.0 * kSumError : kSumError;
    const PointResult result = results_of(scene).front();
    EXPECT_NEAR(result[kStokesI] / expected.i, 1.0, 2.0 * sum_error) << name;
    EXPECT_NEAR(result[kQOverI], expected.q / expected.i, sum_error + result[kErrorEstimate]) << name;
    const bool has_flat_light = !scene.emission && !scene.surroundings;
    if (has_flat_light) {
      EXPECT_NEAR(result[kRhoI], expected.rho, kSumError) << name;
    }
  }
}

TEST(DiffuseFile, Verify_AgreesWithTheReference) {
  const TemporaryFile file("d.csv", "wavelength_um,reflectance\n7,0.1\n8.8,0.6\n9.1,0.05\n11,0.3\n14,0.2\n");
  for (const char* spectrum : {"spectrum.band_um=[8, 14]", "spectrum.wavelength_um=9"}) {
    const SceneValues scene = parse(kSilica, {"surface.diffuse_file=" + file.path(), "surface.specular=0.4", spectrum});
    const TableCheck check = check_table({table_of(scene), {0}}, scene, "diffuse", {});
    for (const CheckedValue& failure : check.failures) ADD_FAILURE() << failure.quantity << ": " << failure.complaint;
  }
}

}  // namespace
}  // namespace dolp::camera_response_test
