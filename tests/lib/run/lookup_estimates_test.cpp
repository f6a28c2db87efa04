// Each result of a lookup states its error. The tests make random tables, some of them coarse, and compare the stated
// errors with the true errors at random points between the entries. The environment variable DOLP_PROPERTY_DRAWS sets
// the number of tables, and DOLP_PROPERTY_SEED sets their seed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include <dolp/status.hpp>
#include "draws.hpp"
#include "run/scene_table.hpp"
#include "scene_run_support.hpp"
#include "table/table_lookup.hpp"

namespace {

using namespace dolp;
using namespace scene_run_support;

constexpr std::size_t kTables = 40;
constexpr std::uint64_t kSeed = 2;
constexpr std::size_t kPoints = 80;  // points per table
constexpr double kExact = 1e-7;      // tolerance of the exact values

/// Values of an axis with equal steps. If `in_ratios`, the distances from `origin` grow by equal factors instead.
std::vector<double> axis(double first, double last, std::size_t count, double origin, bool in_ratios) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    values.push_back(in_ratios ? origin + (first - origin) * std::pow((last - origin) / (first - origin), share)
                               : first + share * (last - first));
  }
  values.back() = last;
  return values;
}

/// A scene with a grid of 4 to about 60 values per axis. In some scenes n, k or the wavelength is an axis, too.
SceneValues random_scene(Draws& draw) {
  const Distribution distribution = draw.chance(0.75) ? Distribution::kCauchy : Distribution::kGaussian;
  const bool is_metal = draw.chance(0.3);
  SceneValues scene = make_scene(distribution, kMaskings[draw.count(0, 3)],
                                 is_metal ? OpticalConstants{draw.log_uniform(1.0, 10.0), draw.log_uniform(1.0, 60.0)}
                                          : OpticalConstants{draw.uniform(1.1, 3.0), draw.chance(0.5) ? 0.0 : 0.2});
  if (draw.chance(0.5)) scene.surroundings.reset();
  if (draw.chance(0.4)) {
    scene.source.emplace().irradiance = draw.uniform(0.1, 5.0);
    if (draw.chance(0.5)) scene.geometry = {Mode::kBistatic, draw.uniform(0.0, 75.0), draw.uniform(0.0, 180.0)};
  }
  const bool is_coarse = draw.chance(0.5);
  const auto values = [&](std::size_t most_coarse, std::size_t most_fine) {
    return is_coarse ? draw.count(4, most_coarse) : draw.count(most_fine / 3, most_fine);
  };
  const double sigma = draw.log_uniform(0.01, 0.3);
  const double q = draw.uniform(1.6, 2.5);
  scene.grid[Axis::kTheta] = axis(0.0, draw.chance(0.3) ? 90.0 : draw.uniform(60.0, 90.0), values(11, 60), 0.0, false);
  scene.grid[Axis::kSigma] = axis(sigma, sigma * draw.log_uniform(3.0, 30.0), values(7, 24), 0.0, draw.chance(0.5));
  scene.grid[Axis::kQ] = axis(q, q + draw.uniform(1.0, 8.0), values(6, 12), 1.0, draw.chance(0.5));
  if (distribution == Distribution::kGaussian) scene.grid[Axis::kQ] = {2.0};
  if (draw.chance(0.15)) {
    scene.grid[Axis::kSigma].resize(4);
    scene.grid[Axis::kQ].resize(1);
    OpticalConstants& index = scene.surface.material.constant;
    scene.grid[Axis::kN] = axis(index.n, index.n * draw.uniform(1.1, 2.0), draw.count(4, 7), 0.0, draw.chance(0.5));
    if (index.k > 0.0) scene.grid[Axis::kK] = axis(index.k, index.k * draw.uniform(1.1, 3.0), 4, 0.0, draw.chance(0.5));
  } else if (draw.chance(0.15)) {
    scene.grid[Axis::kQ].resize(1);
    scene.grid[Axis::kWavelength] = axis(8.0, draw.uniform(9.0, 14.0), draw.count(4, 8), 0.0, false);
  }
  scene.accuracy.tolerance = draw.log_uniform(1e-5, 1e-3);
  return scene;
}

TableValues table_of(const SceneValues& scene) {
  const SceneEntries grid = grid_entries(scene);
  return table_part(table_layout(scene, keep_everything(scene), scene.grid), grid,
                    evaluate_scene(scene, grid, *make_evaluator(Evaluator::kFloat), {}));
}

/// Random points inside the grid, uniform in the coordinates in which a lookup interpolates.
std::vector<TableLookup::Point> random_points(const Axes& grid, Draws& draw) {
  std::vector<TableLookup::Point> points(kPoints);
  for (TableLookup::Point& point : points) {
    for (const Axis axis : kAllAxes) {
      const std::vector<double>& values = grid[axis];
      if (values.empty()) continue;
      const double origin = axis == Axis::kQ ? 1.0 : 0.0;
      const double value = axis == Axis::kTheta || values.size() == 1
                               ? draw.uniform(values.front(), values.back())
                               : origin + draw.log_uniform(values.front() - origin, values.back() - origin);
      point[axis] = std::clamp(value, values.front(), values.back());
    }
  }
  return points;
}

std::vector<PointResult> exact_at(const SceneValues& scene, const std::vector<TableLookup::Point>& points) {
  std::vector<SceneEntry> entries;
  std::vector<double> wavelengths;
  for (const TableLookup::Point& point : points) {
    SceneEntry entry{point[Axis::kTheta], {point[Axis::kSigma], point[Axis::kQ]}, std::nullopt, 0};
    if (!scene.grid[Axis::kN].empty())
      entry.index = OpticalConstants{
          point[Axis::kN], scene.grid[Axis::kK].empty() ? scene.surface.material.constant.k : point[Axis::kK]};
    if (!scene.grid[Axis::kWavelength].empty()) {
      entry.variant = static_cast<std::uint32_t>(wavelengths.size());
      wavelengths.push_back(point[Axis::kWavelength]);
    }
    entries.push_back(entry);
  }
  SceneValues exact = scene;
  exact.accuracy.tolerance = kExact;
  return evaluate_scene(exact, {entries, variants_of(axes_of({}, {}, {}, wavelengths))},
                        *make_evaluator(Evaluator::kDouble), {});
}

/// Totals over the points of all tables.
struct Tally {
  std::size_t points = 0;
  std::size_t flagged = 0;  ///< points for which the lookup reports that DOLP or rho misses the tolerance
  std::size_t missed = 0;   ///< points whose true error of DOLP or rho exceeds the tolerance
  double worst = 0.0;       ///< largest ratio of true error to stated error
  std::vector<double> stated = {};
};

using NextScene = SceneValues (*)(Draws&);

/// Looks up random points in one random table, checks their stated errors, and adds the points to `tally`.
void expect_honest(NextScene next_scene, std::uint64_t seed, std::size_t table_number, Tally& tally) {
  Draws draw(seed * 1000003 + table_number);
  const SceneValues scene = next_scene(draw);
  const TableValues table = table_of(scene);
  const TableLookup lookup(table, scene, "random");
  const std::vector<TableLookup::Point> points = random_points(scene.grid, draw);
  const std::vector<PointResult> exact = exact_at(scene, points);
  for (std::size_t j = 0; j < points.size(); ++j) {
    if (!promises_dolp(exact[j].status)) continue;
    const PointResult found = lookup.at(points[j]);
    if (!promises_dolp(found.status)) continue;
    SCOPED_TRACE(testing::Message() << "table " << table_number << " of seed " << seed << ", theta " << points[j][3]
                                    << ", sigma " << points[j][4] << ", q " << points[j][5] << ", "
                                    << name_of(scene.surface.masking));
    const double dolp_error = std::abs(found[Quantity::kDolp] - exact[j][Quantity::kDolp]);
    const double dolp_stated = found[Quantity::kErrorEstimate] + exact[j][Quantity::kErrorEstimate];
    EXPECT_LE(dolp_error, dolp_stated);
    const double rho_error = std::max(std::abs(found[Quantity::kRhoI] - exact[j][Quantity::kRhoI]),
                                      std::abs(found[Quantity::kRhoQ] - exact[j][Quantity::kRhoQ])) /
                             exact[j][Quantity::kRhoI];
    const double rho_stated = found[Quantity::kRhoErrorEstimate] + exact[j][Quantity::kRhoErrorEstimate];
    EXPECT_LE(rho_error, rho_stated);
    ++tally.points;
    tally.stated.push_back(found[Quantity::kErrorEstimate]);
    tally.flagged += (found.status & kAnyToleranceNotMet) != 0 ? 1 : 0;
    tally.missed += std::max(dolp_error, rho_error) > scene.accuracy.tolerance ? 1 : 0;
    tally.worst = std::max({tally.worst, dolp_error / dolp_stated, rho_error / rho_stated});
  }
}

void expect_honest(NextScene next_scene) {
  const std::size_t tables = draws_wanted(kTables);
  const std::uint64_t seed = draws_wanted(kSeed, "DOLP_PROPERTY_SEED");
  Tally tally;
  for (std::size_t i = 0; i < tables; ++i) expect_honest(next_scene, seed, i, tally);
  EXPECT_GT(tally.points, 40 * tables);
  std::ranges::sort(tally.stated);
  const double share = 100.0 / static_cast<double>(tally.points);
  std::cout << "seed " << seed << ", " << tables << " tables, " << tally.points << " points: largest error "
            << tally.worst << " of what is stated; status 2 at " << share * static_cast<double>(tally.flagged)
            << " %, error above the tolerance at " << share * static_cast<double>(tally.missed)
            << " %; median of the stated errors " << tally.stated[tally.stated.size() / 2] << "\n";
}

/// A scene in bistatic mode, with few values of sigma. With the azimuth 180 degrees, the axis of theta usually contains
/// the specular direction. With other azimuths it does not.
SceneValues bistatic_scene(Draws& draw) {
  SceneValues scene = random_scene(draw);
  scene.surroundings = Surroundings{.temperature_K = 280.0};
  scene.source.emplace().irradiance = draw.log_uniform(0.1, 30.0);
  scene.geometry = {Mode::kBistatic, draw.uniform(0.0, 75.0), draw.chance(0.6) ? 180.0 : draw.uniform(0.0, 180.0)};
  for (const Axis other : {Axis::kN, Axis::kK, Axis::kWavelength}) scene.grid[other].clear();
  scene.grid[Axis::kTheta] = axis(draw.uniform(0.0, 30.0), draw.uniform(70.0, 89.0), draw.count(12, 60), 0.0, false);
  scene.grid[Axis::kSigma] =
      axis(draw.log_uniform(0.03, 0.1), draw.log_uniform(0.3, 1.0), draw.count(4, 12), 0.0, draw.chance(0.7));
  scene.grid[Axis::kQ].resize(scene.grid[Axis::kQ].size() < 4 || draw.chance(0.7) ? 1 : 4);
  return scene;
}

/// A scene whose axis of n begins below 1, where there is total reflection, and ends above 1.
SceneValues scene_across_total_reflection(Draws& draw) {
  SceneValues scene = make_scene(Distribution::kCauchy, kMaskings[draw.count(0, 3)], {0.7, 0.0});
  if (draw.chance(0.5)) scene.surroundings.reset();
  scene.grid[Axis::kTheta] = axis(draw.uniform(0.0, 40.0), draw.uniform(60.0, 85.0), draw.count(8, 30), 0.0, false);
  scene.grid[Axis::kSigma] = axis(draw.log_uniform(0.02, 0.2), 0.4, draw.count(4, 8), 0.0, true);
  scene.grid[Axis::kQ] = {draw.uniform(1.6, 4.0)};
  scene.grid[Axis::kN] = axis(0.7, draw.uniform(1.1, 1.6), draw.count(5, 12), 0.0, draw.chance(0.5));
  return scene;
}

TEST(LookupEstimates, RandomPointsOfRandomTables_ErrorsAreWithinThem) { expect_honest(random_scene); }

TEST(LookupEstimates, RandomPointsOfBistaticTables_ErrorsAreWithinThem) { expect_honest(bistatic_scene); }

TEST(LookupEstimates, RandomPointsAcrossTotalReflection_ErrorsAreWithinThem) {
  expect_honest(scene_across_total_reflection);
}

// A lookup estimates its error from the change of its result when it uses more values of an axis. This change can be
// small by chance, and it can miss a kink of the masking. Lookups allow for both. If they did not, the true error in
// these tables would be 1.8 to 5.7 times the estimate.
TEST(LookupEstimates, TablesWithKinksOrShortAxes_ErrorsAreWithinThem) {
  const struct {
    NextScene next_scene;
    std::uint64_t seed;
    std::size_t table;
  } rows[] = {
      // Tables with v-cavity masking and a kink in one of the last two intervals of theta:
      {bistatic_scene, 101, 207},
      {bistatic_scene, 203, 65},
      {bistatic_scene, 211, 159},
      {bistatic_scene, 208, 61},
      // Tables with four to seven values of sigma:
      {bistatic_scene, 2, 140},
      {bistatic_scene, 102, 69},
      {bistatic_scene, 104, 1},
      {bistatic_scene, 105, 217},
      {bistatic_scene, 204, 153},
      {bistatic_scene, 210, 4},
      {scene_across_total_reflection, 11, 180},
      {scene_across_total_reflection, 13, 51},
  };
  for (const auto& row : rows) {
    Tally tally;
    expect_honest(row.next_scene, row.seed, row.table, tally);
    EXPECT_GT(tally.points, kPoints / 2);
  }
}

TEST(LookupEstimates, SixValuesOfSigmaUnderASource_ErrorIsWithinIt) {
  SceneValues scene = make_scene(Distribution::kCauchy, Masking::kSmith, {1.5, 0.1});
  scene.surroundings = Surroundings{280.0};
  scene.source.emplace().irradiance = 10.0;
  scene.geometry = {Mode::kBistatic, 60.0, 180.0};
  scene.grid = axes_of(axis(20.0, 88.0, 48, 0.0, false), axis(0.05, 0.8, 6, 0.0, true), {2.5});
  scene.accuracy.tolerance = 1e-2;
  const TableValues table = table_of(scene);
  const PointResult found = TableLookup(table, scene, "six").at(70.63829787, 0.17323322517, 2.5);
  EXPECT_NEAR(found[Quantity::kDolp], 0.224068402881, found[Quantity::kErrorEstimate]);
  EXPECT_LT(found[Quantity::kErrorEstimate], 0.1);
}

}  // namespace
