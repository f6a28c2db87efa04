// Derivatives of results by numbers of the scene, in memory and in files.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <fstream>
#include <numbers>

#include "computed_scene.hpp"
#include "error_text.hpp"
#include "in_folder.hpp"
#include "reference/reference_evaluator.hpp"
#include "run/derivatives.hpp"
#include "run/table_run.hpp"
#include "scene/points.hpp"
#include "scene/scene_keys.hpp"
#include "table/table_file.hpp"

namespace dolp::derivatives_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScene = R"toml(
[surface]
n = 1.5
k = 0.1
sigma = 0.2
q = 3.0
masking = "smith"
diffuse = 0.1
specular = 0.8
[emission]
temperature_K = 300
[surroundings]
temperature_K = 250
[spectrum]
wavelength_um = 10
[grid]
theta_deg = [20, 70]
)toml";

/// The derivatives by `keys` at the scene's grid or at points: columns of one value per entry.
std::vector<std::vector<double>> derivatives_with(const SceneValues& scene, const SceneEntries& entries,
                                                  const std::vector<std::string>& keys, ModelEvaluator& evaluator) {
  Run run(scene, entries, {.derivatives = keys}, [&] { return &evaluator; });
  CollectedResults results(run.entries());
  run.compute(results.sink());
  std::vector<std::vector<double>> columns;
  for (const DerivativeColumn& column : results.take().derivatives) columns.push_back(column.values);
  return columns;
}
std::vector<std::vector<double>> derivatives_with(const SceneValues& scene, const std::vector<std::string>& keys) {
  CpuEvaluator evaluator;
  return derivatives_with(scene, grid_entries(scene), keys, evaluator);
}

/// Q/I of the emission of a smooth surface with a real index.
std::complex<double> smooth_q_over_i(std::complex<double> n, double theta_deg) {
  const double theta = theta_deg * std::numbers::pi / 180.0;
  const std::complex<double> inside = std::sqrt(n * n - std::sin(theta) * std::sin(theta));
  const std::complex<double> s = (std::cos(theta) - inside) / (std::cos(theta) + inside);
  const std::complex<double> p = (n * n * std::cos(theta) - inside) / (n * n * std::cos(theta) + inside);
  return (p * p - s * s) / (2.0 - s * s - p * p);
}

TEST(Derivatives, OfASmoothSurfaceByN_AreThoseOfFresnelsEquations) {
  const SceneValues scene = parse(kScene, {"surface.sigma=0", "surface.k=0", "surface.diffuse=0", "surface.specular=1",
                                           "surroundings=none", "grid.sigma=[0]"});
  const std::vector<std::vector<double>> found = derivatives_with(scene, {"surface.n"});
  ASSERT_EQ(found.size(), 3U);
  constexpr double kImaginaryStep = 1e-20;  // Im f(n + ih) / h is the derivative without cancellation
  for (std::size_t i = 0; i < found[0].size(); ++i) {
    const double theta_deg = scene.grid[Axis::kTheta][i];
    const double right = smooth_q_over_i({1.5, kImaginaryStep}, theta_deg).imag() / kImaginaryStep;
    EXPECT_LE(std::abs(found[1][i] - right), found[2][i]) << theta_deg;
    EXPECT_LE(std::abs(found[0][i] + right), found[2][i]) << "Q < 0, so DOLP = -Q/I";
    EXPECT_LT(found[2][i], 1e-4 * std::abs(right));
  }
}

TEST(Derivatives, OfARoughSurface_AgreeWithDifferencesOfTheReference) {
  const std::vector<std::pair<std::string, double>> values = {{"surface.n", 1.5},
                                                              {"surface.k", 0.1},
                                                              {"surface.sigma", 0.2},
                                                              {"surface.q", 3.0},
                                                              {"surface.specular", 0.8},
                                                              {"surface.diffuse", 0.1},
                                                              {"emission.temperature_K", 300.0},
                                                              {"surroundings.temperature_K", 250.0},
                                                              {"spectrum.wavelength_um", 10.0}};
  const SceneValues scene = parse(kScene);
  std::vector<std::string> keys;
  for (const auto& [key, value] : values) keys.push_back(key);
  const std::vector<std::vector<double>> found = derivatives_with(scene, keys);
  constexpr double kShare = 1e-3;  // the difference then errs by 1e-6 and by the reference's 1e-10 over the step
  ReferenceEvaluator reference;
  for (std::size_t j = 0; j < values.size(); ++j) {
    const auto& [key, value] = values[j];
    const auto moved = [&](double share) {
      const SceneValues changed = with_settings(scene, {{key, value * (1.0 + share)}, {"accuracy.tolerance", 1e-10}});
      return evaluate_scene(changed, grid_entries(changed), reference, {});
    };
    const std::vector<PointResult> above = moved(kShare), below = moved(-kShare);
    for (std::size_t i = 0; i < found[0].size(); ++i) {
      const double right = (above[i][Quantity::kQOverI] - below[i][Quantity::kQOverI]) / (2.0 * kShare * value);
      const double change_per_value = 1e-5 / value;  // error of the difference of the reference, in practice
      EXPECT_LE(std::abs(found[3 * j + 1][i] - right), found[3 * j + 2][i] + change_per_value)
          << key << ", entry " << i;
      EXPECT_LT(found[3 * j + 2][i], 1e-4 / value) << key;
    }
  }
}

TEST(Derivatives, OnAxesAndAtPoints_AreThoseOfTheScene) {
  const std::vector<std::string> keys = {"surface.sigma", "surface.n", "emission.temperature_K"};
  const SceneValues grid = parse(kScene, {"grid.sigma=[0.2, 0.4]", "grid.n=[1.4, 1.5]", "grid.temperature_K=[300]"});
  const std::vector<std::vector<double>> right = derivatives_with(parse(kScene), keys);
  const std::vector<std::vector<double>> on_axes = derivatives_with(grid, keys);
  CpuEvaluator evaluator;
  const SceneValues scene = parse(kScene);
  const SceneEntries points = point_entries(
      scene,
      parse_points("theta_deg,sigma,n\n20,0.2,1.5\n70,0.2,1.5\n70,0.4,1.4\n", "p.csv", PointsKind::kDirections, {}));
  const std::vector<std::vector<double>> at_points = derivatives_with(scene, points, keys, evaluator);
  for (std::size_t theta = 0; theta < 2; ++theta) {
    const std::size_t entry = 4 + 2 * theta;  // n varies slower than theta, which varies slower than sigma
    for (std::size_t i = 0; i < right.size(); ++i) {
      const double bound = 2.0 * right[i / 3 * 3 + 2][theta];
      EXPECT_NEAR(on_axes[i][entry], right[i][theta], bound);
      EXPECT_NEAR(at_points[i][theta], right[i][theta], bound);
    }
  }
}

TEST(Derivatives, ByTheWind_FollowFromThoseBySigma) {
  const std::vector<std::string> sea = {"surface.sigma={}", "surface.wind_m_s=5", "surface.distribution=gaussian",
                                        "surface.q={}"};
  const SceneValues windy = parse(kScene, sea);
  std::vector<std::string> calm = sea;
  calm[0] = "surface.sigma=" + std::to_string(windy.surface.sigma);
  calm[1] = "surface.wind_m_s={}";
  const std::vector<double> by_wind = derivatives_with(windy, {"surface.wind_m_s"})[1];
  const std::vector<double> by_sigma = derivatives_with(parse(kScene, calm), {"surface.sigma"})[1];
  const double sigma_per_wind = 0.25 * 0.00512 / windy.surface.sigma;  // sigma^2 = (0.003 + 0.00512 U) / 2
  for (std::size_t i = 0; i < by_wind.size(); ++i) EXPECT_NEAR(by_wind[i], by_sigma[i] * sigma_per_wind, 1e-6);
}

// With surroundings as warm as the surface DOLP is 0. There |Q|/I has a kink, which the steps of the differences cross
// although the kink is up to 1 % of the key away.
// Entries of a grid have the scene's slopes along and across, unless the grid has axes of them.
TEST(Derivatives, BySlopesAlongAndAcross_AreDifferences) {
  constexpr double kStep = 1e-3;
  const std::vector<std::string> base = {"surface.masking=none", "surface.sigma_cross=0.15",
                                         "geometry.surface_azimuth_deg=40", "accuracy.tolerance=1e-8"};
  for (const std::string key : {"surface.sigma_cross", "geometry.surface_azimuth_deg"}) {
    const SceneValues scene = parse(kScene, base);
    const std::vector<std::vector<double>> columns = derivatives_with(scene, {key});
    const double at = std::get<double>(*find_scene_key(key)->value(scene)), step = kStep * at;
    const std::vector<PointResult> below = results_of(with_settings(scene, {{key, at - step}}));
    const std::vector<PointResult> above = results_of(with_settings(scene, {{key, at + step}}));
    for (std::size_t i = 0; i < 2; ++i) {
      const double expected = (above[i][Quantity::kDolp] - below[i][Quantity::kDolp]) / (2.0 * step);
      EXPECT_GT(std::abs(expected), 1e-6) << key;
      EXPECT_NEAR(columns[0][i], expected, 1e-2 * std::abs(expected)) << key;
    }
  }
}

TEST(Derivatives, NearAKinkOfDolp_HaveTheSignOfQ) {
  for (const double surroundings_K : {299.0, 299.9, 299.9999, 300.0001, 300.5}) {
    const SceneValues scene =
        parse(kScene, {"surface.masking=v-cavity", "surroundings.temperature_K=" + std::to_string(surroundings_K)});
    const std::vector<std::vector<double>> columns = derivatives_with(scene, {"surroundings.temperature_K"});
    for (std::size_t i = 0; i < 2; ++i) {
      const double sign = surroundings_K < 300.0 ? -1.0 : 1.0;  // of Q
      EXPECT_GT(std::abs(columns[1][i]), 1e-5);
      EXPECT_NEAR(columns[0][i], sign * columns[1][i], columns[2][i]) << surroundings_K;
      EXPECT_TRUE(std::abs(surroundings_K - 300.0) < 0.01 || columns[2][i] < 0.1 * std::abs(columns[1][i]));
    }
  }
  const SceneValues at_kink = parse(kScene, {"surface.masking=v-cavity", "surroundings.temperature_K=300"});
  const std::vector<std::vector<double>> columns = derivatives_with(at_kink, {"surroundings.temperature_K"});
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_GE(columns[2][i], std::abs(columns[1][i]) + std::abs(columns[0][i]));  // from the left or from the right
}

TEST(Derivatives, AtAnEndOfTheDomain_AreNan) {
  const SceneValues scene = parse(kScene, {"surface.k=0", "surface.specular=0.9", "grid.theta_deg=[0, 40, 90]"});
  const std::vector<std::vector<double>> found =
      derivatives_with(scene, {"surface.k", "surface.diffuse", "surface.specular", "grid.theta_deg"});
  ASSERT_EQ(found.size(), 12U);
  for (std::size_t j = 0; j < 3; ++j) {
    for (const double value : found[j]) EXPECT_TRUE(std::isnan(value)) << "k = 0";
  }
  EXPECT_TRUE(std::isnan(found[9][0])) << "theta = 0";
  EXPECT_TRUE(std::isfinite(found[9][1]));
  EXPECT_TRUE(std::isnan(found[9][2])) << "theta = 90";
}

// The mean slope of smith masking is infinite at q = 1.5, so a step must not reach this value.
TEST(Derivatives, NearTheLeastQOfSmith_StayAboveIt) {
  const std::vector<std::vector<double>> near = derivatives_with(parse(kScene, {"surface.q=1.51"}), {"surface.q"});
  const double right =
      (results_of(parse(kScene, {"surface.q=1.511", "accuracy.tolerance=1e-9"})).back()[Quantity::kQOverI] -
       results_of(parse(kScene, {"surface.q=1.509", "accuracy.tolerance=1e-9"})).back()[Quantity::kQOverI]) /
      0.002;
  EXPECT_NEAR(near[1].back(), right, 0.02 * std::abs(right));  // the difference errs by the share (0.001 / 0.01)^2
  EXPECT_LT(near[2].back(), 0.01 * std::abs(right));
}

TEST(Derivatives, ByWavelengthsAtTheEndsOfATable_AreNanOnlyThere) {
  const TemporaryFile file("index.csv", "wavelength_um,n,k\n9,1.5,0.1\n12,1.7,0.2\n");
  const SceneValues scene =
      parse(kScene, {"surface.n={}", "surface.k={}", "surface.material_file=" + file.path(),
                     "spectrum.wavelength_um={}", "grid.wavelength_um=[9, 10, 12]", "grid.theta_deg=[60]"});
  const std::vector<std::vector<double>> found = derivatives_with(scene, {"spectrum.wavelength_um"});
  ASSERT_EQ(found[0].size(), 3U);
  EXPECT_TRUE(std::isnan(found[0][0]) && std::isnan(found[2][0]));
  EXPECT_LT(found[2][1], 1e-3 * std::abs(found[0][1]));
  EXPECT_TRUE(std::isnan(found[0][2]));
}

// n and k are straight lines between rows 0.1 um apart, so the derivative jumps at each row.
TEST(Derivatives, ByTheWavelength_AreThoseBetweenTwoRows) {
  const std::vector<std::string> silica = {"surface.n={}", "surface.k={}", "surface.material=\"SiO2 fused silica\"",
                                           "surroundings=none", "grid.theta_deg=[60]"};
  const auto at_um = [&](double um) {
    return parse(kScene, joined(silica, std::vector<std::string>{fmt::format("spectrum.wavelength_um={}", um),
                                                                 "accuracy.tolerance=1e-9"}));
  };
  for (const double um : {8.53, 10.0, 10.6}) {
    const auto q_over_i = [&](double own_um) { return results_of(at_um(own_um)).front()[Quantity::kQOverI]; };
    const double expected = (q_over_i(um + 1e-4) - q_over_i(um - 1e-4)) / 2e-4;
    const std::vector<std::vector<double>> found = derivatives_with(at_um(um), {"spectrum.wavelength_um"});
    EXPECT_NEAR(found[1][0], expected, 1e-4 * std::abs(expected)) << um;
    EXPECT_LT(found[2][0], 1e-3 * std::abs(expected)) << um;
  }
}

// Points and tables have a wavelength of their own for each entry. The rows of PMMA are 0.01 um apart here.
TEST(Derivatives, ByWavelengthsOfPointsAndAxes_AreThoseBetweenTwoRows) {
  const std::vector<std::string> plastic = {"surface.n={}", "surface.k={}", "surface.material=\"PMMA acrylic\"",
                                            "surroundings=none", "accuracy.tolerance=1e-9"};
  const auto with_axis = [&](const std::string& um) {
    return parse(kScene, joined(plastic, std::vector<std::string>{"grid.theta_deg=[60]", "grid.wavelength_um=" + um}));
  };
  const SceneValues scene = with_axis("[8.471,8.61789,8.7123]");
  const SceneValues before = with_axis("[8.47099,8.61788,8.71229]"), after = with_axis("[8.47101,8.6179,8.71231]");
  const SceneEntries points = point_entries(
      scene, parse_points("wavelength_um\n8.471\n8.61789\n8.7123\n", "p.csv", PointsKind::kDirections, {}));
  CpuEvaluator evaluator;
  const auto by_points = derivatives_with(scene, points, {"spectrum.wavelength_um"}, evaluator);
  const auto by_axis = derivatives_with(scene, {"spectrum.wavelength_um"});
  const std::vector<PointResult> low = results_of(before), high = results_of(after);
  for (std::size_t i = 0; i < low.size(); ++i) {
    const double expected = (high[i][Quantity::kQOverI] - low[i][Quantity::kQOverI]) / 2e-5;
    for (const auto& found : {by_points, by_axis}) EXPECT_NEAR(found[1][i], expected, found[2][i] + 1e-3) << i;
    EXPECT_LT(by_axis[2][i], 0.01 * std::abs(expected)) << i;
  }
}

// Total reflection begins at n = sin(60 degrees) = 0.866, within the step from 0.87.
TEST(Derivatives, WithAKinkWithinTheStep_HaveItInTheirError) {
  const std::vector<std::string> mirror = {"surface.k=0", "surface.sigma=0", "grid.sigma=[0]",
                                           "surface.masking=v-cavity", "grid.theta_deg=[60]"};
  const auto with_n = [&](double n) {
    return parse(kScene, joined(mirror, std::vector{fmt::format("surface.n={}", n)}));
  };
  const auto q_over_i = [&](double n) { return results_of(with_n(n)).front()[Quantity::kQOverI]; };
  const double expected = (q_over_i(0.87 + 1e-5) - q_over_i(0.87 - 1e-5)) / 2e-5;
  const std::vector<std::vector<double>> found = derivatives_with(with_n(0.87), {"surface.n"});
  EXPECT_GT(std::abs(found[1][0] - expected), 0.1 * std::abs(expected));
  EXPECT_LE(std::abs(found[1][0] - expected), found[2][0]);
}

TEST(Derivatives, ByWhatIsNoNumberOfTheScene_AreRefused) {
  const SceneValues scene = parse(kScene);
  for (const char* key : {"surface.masking", "accuracy.tolerance", "path.transmittance", "surface.wind_m_s",
                          "surface.sigma_cross", "n", "grid.n", ""}) {
    const std::string error = error_text([&] { derivatives_with(scene, {key}); });
    EXPECT_NE(error.find(std::string("derivatives: ") + key + ": is no number of this scene"), std::string::npos)
        << error;
  }
  // A list of points without its own slopes across, like a grid without such an axis.
  const SceneEntries points =
      point_entries(scene, parse_points("theta_deg,sigma\n20,0.2\n", "p.csv", PointsKind::kDirections, {}));
  CpuEvaluator evaluator;
  EXPECT_THROW(derivatives_with(scene, points, {"surface.sigma_cross"}, evaluator), InputError);
  EXPECT_NE(error_text([&] {
              derivatives_with(scene, {"surface.n", "surface.n"});
            }).find("appears twice"),
            std::string::npos);
}

class DerivativeFiles : public InFolder {
 protected:
  void write(const std::string& name, const Shard& shard = {}) const {
    CpuEvaluator evaluator;
    write_table(parse(kScene), {at(name), shard, {.derivatives = {"surface.n", "emission.temperature_K"}}, "cpu"},
                [&] { return &evaluator; });
  }
};

TEST_F(DerivativeFiles, OfAllFormatsAndOfShards_HaveTheSameValues) {
  write("t.nc");
  write("t.csv");
  write("s.1.nc", {1, 2});
  write("s.2.nc", {2, 2});
  ShardSet({at("s.1.nc").string(), at("s.2.nc").string()}).merge(at("m.nc"), "test");
  const TableValues table = read_table(at("t.nc"));
  ASSERT_EQ(table.derivatives.size(), 6U);
  EXPECT_EQ(table.derivatives[0].name, "d_dolp__surface_n");
  EXPECT_EQ(table.derivatives[4].name, "d_q_over_i__emission_temperature_K");
  EXPECT_EQ(table.derivatives[4].units, "K-1");
  EXPECT_EQ(table.derivatives[5].name, "derivative_error__emission_temperature_K");
  const TableValues merged = read_table(at("m.nc"));
  ASSERT_EQ(merged.derivatives.size(), 6U);
  const std::vector<std::vector<double>> right =
      derivatives_with(parse(kScene), {"surface.n", "emission.temperature_K"});
  for (std::size_t j = 0; j < 6; ++j) {
    EXPECT_EQ(table.derivatives[j].values, right[j]);
    EXPECT_EQ(merged.derivatives[j].values, table.derivatives[j].values);
  }
  std::ifstream file(at("t.csv"));
  std::string header;
  std::getline(file, header);
  EXPECT_NE(header.find(",d_dolp__surface_n,d_q_over_i__surface_n,derivative_error__surface_n,"), std::string::npos);
  EXPECT_TRUE(header.ends_with(",status"));
  std::string row;
  while (std::getline(file, row) && row.starts_with('#')) {
  }
  EXPECT_EQ(std::ranges::count(row, ','), std::ranges::count(header, ','));
}

}  // namespace
}  // namespace dolp::derivatives_test
