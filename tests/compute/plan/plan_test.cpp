// Single functions of compute/plan/: cosines, loops, Gauss nodes, kernel rows, refinement levels, tables.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <dolp/status.hpp>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "base/numbers.hpp"
#include "model/angles.hpp"
#include "model/smooth_surface.hpp"
#include "plan/breakpoints.hpp"
#include "plan/constants.hpp"
#include "plan/kernel_data.hpp"
#include "plan/refinement.hpp"
#include "plan/reflectance_curve.hpp"
#include "plan/rows.hpp"
#include "plan/rule.hpp"
#include "plan/shape_plan.hpp"
#include "plan/sky_table.hpp"

namespace dolp {
namespace {

// ---- Directions ----------------------------------------------------------------------------------------------------

TEST(CosSinDeg, MultiplesOf90_AreExact) {
  const std::array<std::array<double, 3>, 5> exact = {
      {{0.0, 1.0, 0.0}, {90.0, 0.0, 1.0}, {180.0, -1.0, 0.0}, {270.0, 0.0, -1.0}, {360.0, 1.0, 0.0}}};
  for (const auto& [angle_deg, cosine, sine] : exact) {
    EXPECT_EQ(cos_sin_deg(angle_deg).cos, cosine) << angle_deg;
    EXPECT_EQ(cos_sin_deg(angle_deg).sin, sine) << angle_deg;
  }
}

TEST(CosSinDeg, OtherAngles_AgreeWithTheLibrary) {
  // Pi times the rounding error of angle_deg / 180, plus the rounding error of the result.
  constexpr double kTolerance = 5e-16;
  for (double angle_deg = -90.0; angle_deg <= 360.0; angle_deg += 0.37) {
    const long double angle = angle_deg * std::numbers::pi_v<long double> / 180.0L;
    EXPECT_NEAR(cos_sin_deg(angle_deg).cos, static_cast<double>(std::cos(angle)), kTolerance) << angle_deg;
    EXPECT_NEAR(cos_sin_deg(angle_deg).sin, static_cast<double>(std::sin(angle)), kTolerance) << angle_deg;
  }
}

// ---- Loops ---------------------------------------------------------------------------------------------------------

// After this number of loop iterations, an invocation on lavapipe (Mesa's CPU driver) stops without an error.
constexpr double kDriverLimit = 65535.0;

TEST(Loops, HardDirectionsAndIndicesAtEveryTolerance_StayBelowTheDriversLimit) {
  MomentsRequest request;
  request.theta_deg = {0.0, 1e-6, 12.857142857, 12.9, 18.0, 30.0, 30.2, 44.9, 45.0, 45.1, 60.0, 89.99, 90.0};
  request.sigma = {0.3, 1e-3, 5.0};
  request.q = {2.0, 1.6, 45.0};
  for (const bool total_reflection : {false, true}) {
    request.optics = {{1.508, 0.0}, {27.0, 90.0}};
    if (total_reflection) {
      for (const double n : {0.999, 0.8, std::numbers::sqrt2 / 2.0, 0.5, 0.1}) request.optics.push_back({n, 0.0});
    }
    for (const Distribution distribution : {Distribution::kCauchy, Distribution::kGaussian}) {
      for (int masking = 0; masking <= 4; ++masking) {  // 0 to 3: maskings; 4: all bounces
        request.distribution = distribution;
        request.masking = masking == 4 ? Masking::kVCavity : static_cast<Masking>(masking);
        request.scattering = masking == 4 ? Scattering::kMultiple : Scattering::kSingle;
        for (int exponent = 2; exponent <= 15; ++exponent) {
          request.tolerance = std::pow(10.0, -exponent);
          const double iterations = worst_iterations(kernel_data(request));
          EXPECT_TRUE(iterations > 0.0 && iterations < kDriverLimit) << iterations << " at " << request.tolerance;
        }
      }
    }
  }
  // A kernel loops over the nodes of the masking table. For each node it sums a Gauss rule of at most this order.
  constexpr double kTableOrderAtMost = 8.0;
  EXPECT_LT(DOLP_MASKING_NODES(DOLP_MASKING_CELL_BITS_DOUBLE) * (1.0 + kTableOrderAtMost), kDriverLimit);
}

// The integrands are Chebyshev polynomials. Their maximum is 1, so the error of a too low order is far above rounding.
TEST(GaussLegendre, Orders_IntegratePolynomialsOfDegree2nMinus1AndNoMore) {
  for (const int order : {1, 2, 3, 7, 20, DOLP_MAX_ORDER}) {
    for (int degree = 0; degree <= 2 * order; degree += 2) {
      double sum = 0.0;
      for (const auto& [x, weight] : gauss_legendre(order)) sum += weight * std::cos(degree * std::acos(x));
      const double error = std::abs(sum - 2.0 / (1.0 - static_cast<double>(degree) * degree));
      const double rounding = 1e-15 * (2.0 + 0.2 * degree);
      EXPECT_EQ(error <= rounding, degree < 2 * order) << order << " " << degree;
    }
  }
}

// ---- Slopes and rows -----------------------------------------------------------------------------------------------

double tan_deg(double angle_deg) { return std::tan(angle_deg * std::numbers::pi / 180.0); }

// The expected slopes are in section 8 of shaders/physics/README.md. There t_1 = cos(theta) / (1 + sin(theta)), which
// is tan(45 degrees - theta/2).
TEST(Breakpoints, Directions_AreAtTheAnglesWhereLinesMeet) {
  constexpr unsigned kBoth = kRootAbove | kRootBelow;
  struct Case {
    double theta_deg;
    Masking masking;
    DirectionVariant variant;
    // For each breakpoint: atan(slope) in degrees, and the sides on which the integrand behaves like a square root.
    std::vector<std::pair<double, unsigned>> expected;
  };
  const std::vector<Case> cases = {
      {0.0, Masking::kNone, {}, {{0, 0}, {45, kBoth}}},
      {60.0, Masking::kNone, {}, {{0, 0}, {15, kRootAbove}, {75, kRootBelow}}},
      {60.0, Masking::kIntegral, {}, {{0, 0}, {15, kRootAbove}, {60, kRootBelow}, {75, kRootBelow}}},
      {60.0, Masking::kSmith, {0.0, true}, {{0, 0}, {15, kRootAbove}, {30, kBoth}, {75, kRootBelow}}},
      {20.0, Masking::kNone, {0.5, false}, {{0, 0}, {20, kBoth}, {35, kRootAbove}, {40, kBoth}, {55, kRootBelow}}},
      {60.0,
       Masking::kVCavity,
       {},
       {{0, 0}, {10, kRootAbove}, {15, kRootAbove}, {30, kRootAbove}, {45, 0}, {60, kRootBelow}, {75, kRootBelow}}}};
  for (const auto& [theta_deg, masking, variant, expected] : cases) {
    const std::vector<Breakpoint> points = breakpoints(theta_deg, {.masking = masking}, variant, {}, 1);
    ASSERT_EQ(points.size(), expected.size()) << theta_deg;
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(points[i].slope, tan_deg(expected[i].first), 1e-14 * (1.0 + points[i].slope))
          << theta_deg << " " << i;
      EXPECT_EQ(points[i].roots, expected[i].second) << theta_deg << " " << i;
    }
  }
}

// Groove with the slope angle alpha, in degrees: a vertical ray leaves after 90 / (90 - alpha) bounces.
TEST(SlopeWithBounces, Bounces_FollowFromTheAngleOfTheGroove) {
  EXPECT_NEAR(slope_with_bounces(2.0), 1.0, 1e-15);
  EXPECT_NEAR(slope_with_bounces(3.0), tan_deg(60.0), 1e-14);
  EXPECT_NEAR(slope_with_bounces(9.0), tan_deg(80.0), 1e-13);
}

TEST(Rows, WantedEntriesOfAGrid_AreEachInOneRowOfShapesAlike) {
  MomentsRequest request{.masking = Masking::kSmith,
                         .theta_deg = {10.0, 70.0},
                         .optics = {{1.5, 0.0}, {0.8, 0.0}},
                         .sigma = {0.1, 0.3},
                         .q = {8.0, 3.0, 2.5, 2.0, 1.75, 40.0, 2.2, 2.1}};
  for (std::size_t i = 0; i < request.size(); ++i) request.wanted.push_back(i % 3 == 0 ? 1 : 0);
  const KernelData data = kernel_data(request);
  const Rows rows = rows_of(request, data);
  EXPECT_EQ(rows.width, kRowWidth);
  std::multiset<std::size_t> found;
  for (const Row& row : rows.rows) {
    const Chunk& chunk = rows.chunks[row.chunk];
    std::uint32_t used = 0;
    for (std::uint32_t i = chunk.first; i < chunk.first + chunk.count; ++i) {
      EXPECT_LE(rows.shapes[i].q_minus_1, kMostRowSpread * rows.shapes[chunk.first].q_minus_1);
      const std::size_t entry = data.entry_of(row.direction, row.index, rows.shape_of[i]);
      if (request.is_wanted(entry)) found.insert(entry), ++used;
    }
    EXPECT_EQ(row.used, used);
  }
  EXPECT_EQ(found.size(), request.wanted_count());
  EXPECT_EQ(std::set<std::size_t>(found.begin(), found.end()).size(), found.size());
  const std::vector<RowPiece> pieces = pieces_of(rows, data, 0, static_cast<std::uint32_t>(rows.rows.size()));
  std::size_t expected = 0;
  for (const Row& row : rows.rows)
    expected += piece_count(data, rows.theta_of(data, row), rows.shapes[rows.chunks[row.chunk].first]);
  EXPECT_EQ(pieces.size(), expected);
  request.q.resize(2);
  request.wanted.clear();
  EXPECT_EQ(rows_of(request, kernel_data(request)).width, 1U);  // rows with 4 places would hold 2 entries each
}

// ---- Orders and levels ---------------------------------------------------------------------------------------------

TEST(Rule, DigitsAndShapes_DecideOrdersAndLines) {
  EXPECT_DOUBLE_EQ(rule_digits({.margin_digits = 2.0}, 1e-3), 6.25);  // (3 + 2) / kCoarseShare
  EXPECT_EQ(largest_order(4.0), 64);
  EXPECT_EQ(largest_order(10.0), 80);
  EXPECT_EQ(largest_order(99.0), DOLP_MAX_ORDER);
  EXPECT_EQ(split_bounces(0.5), 1);
  EXPECT_EQ(split_bounces(5.0), 2);
  EXPECT_EQ(split_bounces(99.0), DOLP_MOST_SPLITS);
  const auto gaussian_line = [](double sigma, double digits) {
    return needs_line(Distribution::kGaussian, Masking::kIntegral, {sigma, 2.0}, digits, 1e-4);
  };
  EXPECT_TRUE(gaussian_line(0.61, 7.0) && !gaussian_line(0.59, 7.0));
  EXPECT_TRUE(gaussian_line(0.31, 9.0) && !gaussian_line(0.29, 9.0));
  EXPECT_FALSE(needs_line(Distribution::kCauchy, Masking::kNone, {1.0, 1.6}, 7.0, 1e-4));
  // With integer q, Smith's masking is a smooth function of theta, so it has no cusp.
  EXPECT_LT(cusp_digits(Distribution::kCauchy, Masking::kSmith, {0.3, 3.0}, 7.0), -100.0);
  EXPECT_GT(cusp_digits(Distribution::kCauchy, Masking::kSmith, {0.3, 2.5}, 7.0), -10.0);
}

TEST(Refinement, Levels_TightenByHalfDecadesAndTurnToDouble) {
  constexpr Precision kFloat = Precision::kFloat, kDouble = Precision::kDouble;
  EXPECT_EQ(first_level({.tolerance = 1e-4}, true).precision, kFloat);
  EXPECT_EQ(first_level({.tolerance = 1e-6}, true).precision, kDouble);
  EXPECT_EQ(first_level({.tolerance = 1e-6}, false).precision, kFloat);
  EXPECT_EQ(first_level({.tolerance = 1e-6, .precision = kFloat}, true).precision, kFloat);
  EXPECT_DOUBLE_EQ(check_level({.tolerance = 1e-2}).tolerance, 1e-4);
  EXPECT_DOUBLE_EQ(check_level({.tolerance = 1e-4}).tolerance, kLeastFloatTolerance);
  struct Case {
    RefinementLevel last;
    double missed_by;  // error divided by the tolerance 1e-3
    bool has_double;
    std::optional<RefinementLevel> expected;
  };
  const std::vector<Case> cases = {// first case: the error is 10 times too large. With the safety
                                   // factor 1.5, log10(15) = 1.18, rounded up to 1.5 decades
                                   {{kFloat, 1e-3}, 10.0, true, RefinementLevel{kFloat, 1e-3 * std::pow(10.0, -1.5)}},
                                   {{kFloat, 1e-3}, 1.1, true, RefinementLevel{kFloat, 1e-3 * std::pow(10.0, -0.5)}},
                                   {{kFloat, 1e-3}, kInfinity, true, RefinementLevel{kDouble, 1e-8}},
                                   {{kFloat, 1e-3}, kInfinity, false, RefinementLevel{kFloat, kLeastFloatTolerance}},
                                   {{kFloat, kLeastFloatTolerance}, 10.0, false, std::nullopt},
                                   {{kDouble, 1e-15}, 10.0, true, std::nullopt}};
  for (const auto& [last, missed_by, has_double, expected] : cases) {
    PointResult result;
    EXPECT_FALSE(next_level(last, result, {.tolerance = 1e-3}, has_double));  // the result meets the tolerance
    result.status = kToleranceNotMet;
    result[Quantity::kErrorEstimate] = result[Quantity::kRhoErrorEstimate] = 1e-3 * missed_by;
    const auto next = next_level(last, result, {.tolerance = 1e-3}, has_double);
    ASSERT_EQ(next.has_value(), expected.has_value()) << missed_by;
    if (!next) continue;
    EXPECT_EQ(next->precision, expected->precision) << missed_by;
    EXPECT_NEAR(next->tolerance, expected->tolerance, 1e-12 * expected->tolerance) << missed_by;
  }
}

TEST(ShapePlan, Nodes_SpanTheAxesAndTheirWeightsSumToOne) {
  MomentsRequest request{.masking = Masking::kIntegral, .theta_deg = {0.0, 89.95, 60.0}, .optics = {{1.5, 0.0}}};
  EXPECT_EQ(split_grazing_directions(request), (std::vector<std::vector<std::size_t>>{{0, 2}, {1}}));
  request.masking = Masking::kVCavity;
  EXPECT_EQ(split_grazing_directions(request), (std::vector<std::vector<std::size_t>>{{0, 1, 2}}));
  for (double i = 0.0; i < 64.0; ++i) request.sigma.push_back(0.05 + 0.01 * i), request.q.push_back(1.75 + 0.05 * i);
  const auto plan = shape_plan(request);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->sigma.nodes.front(), request.sigma.back());
  EXPECT_EQ(plan->q.nodes.back(), request.q.front());
  for (const ShapeAxis* axis : {&plan->sigma, &plan->q}) {
    EXPECT_LT(axis->nodes.size(), 64U);
    EXPECT_LT((axis->cardinal.rowwise().sum().array() - 1.0).abs().maxCoeff(), 1e-13);
  }
  request.wanted.assign(request.size(), 1);
  request.wanted.back() = 0;  // now the last direction lacks an entry
  EXPECT_FALSE(shape_plan(request));
}

// ---- Tables --------------------------------------------------------------------------------------------------------

TEST(ReflectanceCurve, CubicsOfAFilm_KeepTheirBound) {
  FacetOptics optics(1.5, 0.0);
  optics.films = {{{2.2, 0.01}, 0.8}};
  const ReflectanceCurve curve = reflectance_curve(optics, 1e-4);
  ASSERT_EQ(curve.nodes.size(), curve.cells * DOLP_CURVE_NODES);
  EXPECT_LT(curve.error, 1e-4);
  for (double v = 0.0005; v < 1.0; v += 0.0031) {
    const double position = v * static_cast<double>(curve.cells);
    const auto cell = static_cast<std::size_t>(position);
    const double x = position - static_cast<double>(cell);
    const auto read = [&](std::size_t part) {
      const auto* node = &curve.nodes[cell * DOLP_CURVE_NODES + 2 * part];
      return node[0][0] + x * (node[0][1] + x * (node[1][0] + x * node[1][1]));
    };
    const SmoothAbsorptance absorbed = smooth_absorptance(optics, v * v);
    EXPECT_NEAR(read(0), 1.0 - absorbed.s, curve.error) << v;
    EXPECT_NEAR(read(1), absorbed.s, curve.error) << v;
    EXPECT_NEAR(read(2) * (1.0 - std::pow(v, 4.0)), absorbed.split * (1.0 - std::pow(v, 4.0)), curve.error) << v;
  }
}

// Straight lines between rows have kinks at the rows, which are in different cells.
TEST(ReflectanceCurve, MeasuredRows_AreReadWithTheirKinks) {
  const auto rows = std::make_shared<MeasuredReflectance>();
  rows->beta_deg = {0.0, 3.0, 5.0, 40.0, 41.5, 80.0, 90.0};
  rows->r_s = {0.3, 0.4, 0.2, 0.9, 0.1, 0.8, 0.7};
  rows->r_p = {0.3, 0.35, 0.6, 0.5, 0.2, 0.1, 0.9};
  FacetOptics optics;
  optics.measured = rows;
  const ReflectanceCurve curve = reflectance_curve(optics, 1e-6);
  EXPECT_LT(curve.error, 1e-6);
  std::size_t beyond = 0;
  for (double beta_deg = 0.005; beta_deg < 90.0; beta_deg += 0.0173) {
    const double cosine = std::cos(beta_deg * std::numbers::pi / 180.0);
    const double position = std::sqrt(1.0 - cosine) * static_cast<double>(curve.cells);
    const auto cell = static_cast<std::size_t>(position);
    const double x = position - static_cast<double>(cell);
    const auto& [kink, after] = curve.nodes[curve.cells * DOLP_CURVE_NODES + cell];
    const auto first = x > kink ? static_cast<std::size_t>(after) : cell * DOLP_CURVE_NODES;
    beyond += x > kink ? 1 : 0;
    const auto read = [&](std::size_t part) {
      const auto* node = &curve.nodes[first + 2 * part];
      return node[0][0] + x * (node[0][1] + x * (node[1][0] + x * node[1][1]));
    };
    const SmoothAbsorptance absorbed = smooth_absorptance(optics, cosine);
    EXPECT_NEAR(read(0), 1.0 - absorbed.s, curve.error) << beta_deg;
    EXPECT_NEAR(read(1), absorbed.s, curve.error) << beta_deg;
    const double sin2 = (1.0 - cosine) * (1.0 + cosine);
    EXPECT_NEAR(read(2) * sin2, absorbed.split * sin2, curve.error) << beta_deg;
  }
  EXPECT_GT(beyond, 0U);
}

TEST(KernelData, SceneTolerance_LimitsTheTablesOfTighterLevels) {
  FacetOptics film(1.5, 0.0);
  film.films = {{{2.2, 0.01}, 5.8}};
  MomentsRequest request{.tolerance = 1e-5, .theta_deg = {40.0}, .optics = {film}, .sigma = {0.2}, .q = {2.0}};
  const double cells = kernel_data(request).indices[0].curve_cells;
  request.tolerance = 1e-8;
  EXPECT_GT(kernel_data(request).indices[0].curve_cells, cells);
  request.scene_tolerance = 1e-4;  // tables have a tenth of it
  EXPECT_EQ(kernel_data(request).indices[0].curve_cells, cells);
}

TEST(SkyTable, CellsOfAFunctionWithACorner_KeepTheirBoundBesideIt) {
  const SkyNodes sky_nodes({0.0, 50.0, 90.0});
  Eigen::VectorXd values(static_cast<Eigen::Index>(sky_nodes.zenith_deg().size()));
  for (Eigen::Index i = 0; i < values.size(); ++i)
    values[i] = 0.2 + std::abs(sky_nodes.zenith_deg()[static_cast<std::size_t>(i)] - 50.0) / 90.0;
  const SkyBasis basis(sky_nodes, {values}, 1e-9);
  std::vector<std::array<double, 2>> nodes(7);
  const SkyTable table = append_sky(basis, {1e-4, 1e-4}, true, nodes);
  EXPECT_EQ(table.start, 7U);
  EXPECT_EQ(table.corners_deg, std::vector<double>{50.0});
  const std::size_t cells = std::size_t{1} << table.log2_cells;
  ASSERT_EQ(nodes.size(), 7 + cells + 1);
  EXPECT_NEAR(nodes.back()[0], std::cos(50.0 * std::numbers::pi / 180.0), 1e-15);
  for (double zenith_deg = 1.0; zenith_deg < 90.0; zenith_deg += 1.7) {
    const double position = std::sqrt(1.0 - cos_sin_deg(zenith_deg).cos) * static_cast<double>(cells);
    const auto& [start, rise] = nodes[7 + static_cast<std::size_t>(position)];
    EXPECT_NEAR(start + (position - std::floor(position)) * rise, basis.at(zenith_deg)[0], table.error[0] + 1e-12);
  }
  EXPECT_EQ(table.word(), 7U << DOLP_SKY_START_SHIFT | 1U << DOLP_SKY_CORNERS_SHIFT | table.log2_cells);
  EXPECT_EQ(SkyTable{}.word(), 0U);
}

}  // namespace
}  // namespace dolp
