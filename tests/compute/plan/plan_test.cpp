// Single functions of compute/plan/: cosines, loops, breakpoints, refinement levels, tables, geometry of beams.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <dolp/status.hpp>
#include <numbers>
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

namespace dolp::plan_test {
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

// ---- Loops ---------------------------------------------------------------------------------------------------------

// An invocation on lavapipe (Mesa's CPU driver) stops after 65,535 loop iterations, without an error. The plan gives
// the arcs as many nodes as this limit allows.
TEST(Loops, HardDirectionsAndIndicesAtEveryTolerance_LeaveNodesBelowTheDriversLimit) {
  MomentsRequest request;
  request.theta_deg = {0.0, 1e-6, 12.857142857, 12.9, 18.0, 30.0, 30.2, 44.9, 45.0, 45.1, 60.0, 89.99, 90.0};
  request.shapes = shape_product(std::array{0.3, 1e-3, 5.0}, std::array{2.0, 1.6, 45.0});
  for (const bool total_reflection : {false, true}) {
    request.optics = {{1.508, 0.0}, {27.0, 90.0}};
    if (total_reflection) {
      for (const double n : {0.999, 0.8, std::numbers::sqrt2 / 2.0, 0.5, 0.1}) request.optics.push_back({n, 0.0});
    }
    request.set_grid();
    for (const Distribution distribution : {Distribution::kCauchy, Distribution::kGaussian}) {
      for (int masking = 0; masking <= 4; ++masking) {  // 0 to 3: maskings; 4: all bounces
        request.distribution = distribution;
        request.masking = masking == 4 ? Masking::kVCavity : static_cast<Masking>(masking);
        request.scattering = masking == 4 ? Scattering::kMultiple : Scattering::kSingle;
        for (int exponent = 2; exponent <= 15; ++exponent) {
          request.tolerance = std::pow(10.0, -exponent);
          const KernelData data = kernel_data(request);
          for (const Pieces& pieces : data.pieces) {
            for (std::uint32_t i = 0; i < pieces.count; ++i)
              ASSERT_TRUE(pieces.most_nodes[i] > 0 && pieces.most_nodes[i] <= data.rule_order) << request.tolerance;
          }
        }
      }
    }
  }
  // A kernel loops over the nodes of the masking table. For each node it sums a Gauss rule of at most this order.
  constexpr int kTableOrderAtMost = 8;
  EXPECT_LT(DOLP_MASKING_NODES(DOLP_MASKING_CELL_BITS_DOUBLE) * (1 + kTableOrderAtMost), 65535);
}

// ---- Slopes --------------------------------------------------------------------------------------------------------

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
    MomentsRequest request;
    request.masking = masking;
    const std::vector<Breakpoint> points = breakpoints(theta_deg, request, variant, {}, 1);
    ASSERT_EQ(points.size(), expected.size()) << theta_deg;
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(points[i].slope, tan_deg(expected[i].first), 1e-14 * (1.0 + points[i].slope))
          << theta_deg << " " << i;
      EXPECT_EQ(points[i].roots, expected[i].second) << theta_deg << " " << i;
    }
  }
}

// ---- Refinement levels ---------------------------------------------------------------------------------------------

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

// ---- Tables --------------------------------------------------------------------------------------------------------

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
  MomentsRequest request;
  request.tolerance = 1e-5;
  request.append({40.0, {0.2, 2.0}, film});
  const double cells = kernel_data(request).indices[0].curve_cells;
  request.tolerance = 1e-8;
  EXPECT_GT(kernel_data(request).indices[0].curve_cells, cells);
  request.scene_tolerance = 1e-4;  // tables have a tenth of it
  EXPECT_EQ(kernel_data(request).indices[0].curve_cells, cells);
}

}  // namespace
}  // namespace dolp::plan_test
