// Lookups in artificial tables whose values between the entries are known, and the errors that lookups state.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <dolp/errors.hpp>
#include <limits>

#include <dolp/status.hpp>
#include "draws.hpp"
#include "error_text.hpp"
#include "table/table_lookup.hpp"

namespace {

using namespace dolp;
/// The values of an artificial table. They are smooth in theta, ln(sigma) and ln(q - 1); Q changes its sign.
struct Truth {
  double i, q, rho_i, rho_q, albedo;
};
Truth truth(double theta_deg, double sigma, double q) {
  const double x = theta_deg / 30.0;
  const double s = std::log(sigma);
  const double t = std::log(q - 1.0);
  return {20.0 + std::cos(x) + 0.3 * s * s, std::sin(x - 0.5 + 0.1 * s) + 0.2 * t, 0.4 + 0.1 * std::sin(x + s),
          0.05 * x * std::exp(0.1 * t), 0.9 + 0.05 * std::cos(s + t)};
}

constexpr double kEntryError = 1e-7;

SceneModel with_tolerance(double tolerance) {
  SceneModel scene;
  scene.accuracy.tolerance = tolerance;
  return scene;
}

TableValues made_up(const std::vector<double>& theta, const std::vector<double>& sigma, const std::vector<double>& q) {
  TableValues table;
  table.axes[Axis::kTheta] = theta;
  table.axes[Axis::kSigma] = sigma;
  table.axes[Axis::kQ] = q;
  for (const double a : theta) {
    for (const double b : sigma) {
      for (const double c : q) {
        const Truth t = truth(a, b, c);
        table[Quantity::kStokesI].push_back(t.i);
        table[Quantity::kStokesQ].push_back(t.q);
        table[Quantity::kStokesU].push_back(0.0);
        table[Quantity::kStokesV].push_back(0.0);
        table[Quantity::kRhoI].push_back(t.rho_i);
        table[Quantity::kRhoQ].push_back(t.rho_q);
        table[Quantity::kAlbedo].push_back(t.albedo);
        table[Quantity::kDolp].push_back(std::abs(t.q) / t.i);
        table[Quantity::kErrorEstimate].push_back(kEntryError);
        table[Quantity::kRhoErrorEstimate].push_back(kEntryError);
        table.status.push_back(0);
      }
    }
  }
  return table;
}

void expect_holds(const PointResult& result, double theta_deg, double sigma, double q) {
  const Truth t = truth(theta_deg, sigma, q);
  EXPECT_NEAR(result[Quantity::kDolp], std::abs(t.q) / t.i, result[Quantity::kErrorEstimate])
      << theta_deg << " " << sigma << " " << q;
  EXPECT_NEAR(result[Quantity::kRhoI], t.rho_i, result[Quantity::kRhoErrorEstimate] * t.rho_i)
      << theta_deg << " " << sigma << " " << q;
  EXPECT_NEAR(result[Quantity::kRhoQ], t.rho_q, result[Quantity::kRhoErrorEstimate] * t.rho_i)
      << theta_deg << " " << sigma << " " << q;
}

TEST(TableLookup, BetweenEntries_ErrorIsWithinWhatIsStated) {
  for (const std::size_t count : {3U, 5U, 9U, 17U, 33U}) {
    const TableValues table = made_up(spaced(0, 80, count), spaced(0.1, 1.0, count), spaced(1.5, 6.0, count));
    const TableLookup lookup(table, with_tolerance(1e-4), "t.nc");
    double worst = 0.0;
    for (const double theta : {1.0, 33.3, 47.0, 79.0}) {
      for (const double sigma : {0.11, 0.37, 0.98}) {
        for (const double q : {1.51, 2.2, 5.7}) {
          const PointResult result = lookup.at(theta, sigma, q);
          expect_holds(result, theta, sigma, q);
          worst = std::max(worst, result[Quantity::kErrorEstimate]);
          EXPECT_EQ((result.status & kAnyToleranceNotMet) != 0,
                    result[Quantity::kErrorEstimate] > 1e-4 || result[Quantity::kRhoErrorEstimate] > 1e-4);
        }
      }
    }
    if (count >= 33) {
      EXPECT_LT(worst, 1e-4);
    }
    if (count == 3) {
      EXPECT_GT(worst, 1e-3);
    }
  }
}

TEST(TableLookup, AtAnEntry_ItsValuesAndItsErrors) {
  const TableValues table = made_up(spaced(0, 80, 9), {0.1, 0.3, 0.9}, {2.0, 3.0});
  const TableLookup lookup(table, with_tolerance(1e-4), "t.nc");
  const std::size_t position = table.position(4, 1, 1);
  const PointResult result = lookup.at(40.0, 0.3, 3.0);
  EXPECT_EQ(result[Quantity::kStokesQ], table[Quantity::kStokesQ][position]);
  EXPECT_EQ(result[Quantity::kRhoI], table[Quantity::kRhoI][position]);
  EXPECT_NEAR(result[Quantity::kErrorEstimate], kEntryError, 1e-15);
  EXPECT_NEAR(result[Quantity::kRhoErrorEstimate], kEntryError, 1e-15);
  EXPECT_EQ(result.status, 0U);
}

TEST(TableLookup, AxisWithTwoOrThreeValues_StatesNoErrorBetweenThem) {
  const TableValues table = made_up(spaced(0, 80, 9), {0.1, 0.3, 0.9}, {2.0});
  const TableLookup lookup(table, with_tolerance(1e-4), "t.nc");
  const PointResult between = lookup.at(41.0, 0.2, 2.0);
  EXPECT_TRUE(std::isinf(between[Quantity::kErrorEstimate]) && std::isinf(between[Quantity::kRhoErrorEstimate]));
  EXPECT_EQ(between.status, kToleranceNotMet | kRhoToleranceNotMet);
  EXPECT_TRUE(std::isfinite(lookup.at(41.0, 0.3, 2.0)[Quantity::kErrorEstimate]));
}

TEST(TableLookup, AxesWithOneValue_AreNotInterpolated) {
  const TableValues table = made_up(spaced(0, 80, 33), {0.3}, {2.0});
  const TableLookup lookup(table, with_tolerance(1e-4), "t.nc");
  const PointResult result = lookup.at(41.3, 0.3, 2.0);
  expect_holds(result, 41.3, 0.3, 2.0);
  EXPECT_LT(result[Quantity::kErrorEstimate], 1e-5);
}

TEST(TableLookup, DescendingAxes_TheSameResult) {
  const TableValues up = made_up(spaced(0, 80, 9), spaced(0.1, 1.0, 7), {2.0, 3.0, 4.0, 5.0});
  const TableValues down = made_up(spaced(80, 0, 9), spaced(1.0, 0.1, 7), {5.0, 4.0, 3.0, 2.0});
  const PointResult a = TableLookup(up, with_tolerance(1e-4), "").at(33.0, 0.42, 2.7);
  const PointResult b = TableLookup(down, with_tolerance(1e-4), "").at(33.0, 0.42, 2.7);
  EXPECT_NEAR(a[Quantity::kDolp], b[Quantity::kDolp], 1e-12);
  EXPECT_NEAR(a[Quantity::kErrorEstimate], b[Quantity::kErrorEstimate], 1e-12);
}

TEST(TableLookup, NextToUnknownEntries_ReadsThoseItKnows) {
  TableValues table = made_up(spaced(0, 90, 19), {0.3}, {2.0});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::size_t last = table.size() - 1;  // 90 degrees
  for (const Quantity quantity : {Quantity::kStokesI, Quantity::kStokesQ, Quantity::kStokesU, Quantity::kStokesV,
                                  Quantity::kRhoI, Quantity::kRhoQ, Quantity::kErrorEstimate}) {
    table[quantity][last] = nan;
  }
  table.status[last] = kOutsideModelDomain | kReflectanceOutsideZeroToOne;
  const TableLookup lookup(table, with_tolerance(1e-3), "t.nc");
  const PointResult before = lookup.at(84.0, 0.3, 2.0);
  expect_holds(before, 84.0, 0.3, 2.0);
  EXPECT_EQ(before.status, 0U);
  table[Quantity::kDolp][last] = 0.25;  // a limit
  table[Quantity::kErrorEstimate][last] = 1e-5;
  const PointResult at_horizon = lookup.at(90.0, 0.3, 2.0);
  EXPECT_EQ(at_horizon[Quantity::kDolp], 0.25);
  EXPECT_EQ(at_horizon[Quantity::kErrorEstimate], 1e-5);
  EXPECT_EQ(at_horizon.status, table.status[last]);
  const PointResult between = lookup.at(87.0, 0.3, 2.0);
  EXPECT_TRUE(std::isnan(between[Quantity::kDolp]));
  EXPECT_EQ(between.status, kOutsideModelDomain);
}

TEST(TableLookup, StatusOfTheCell_IsKept_AndNegativeIntensityIsFound) {
  TableValues table = made_up(spaced(0, 80, 9), {0.3}, {2.0});
  table.status[5] = kReflectanceOutsideZeroToOne;
  for (std::size_t i = 6; i < table.size(); ++i) table[Quantity::kStokesI][i] = -1.0;
  const TableLookup lookup(table, with_tolerance(1e-3), "t.nc");
  EXPECT_EQ(lookup.at(12.0, 0.3, 2.0).status & kReflectanceOutsideZeroToOne, 0U);
  EXPECT_NE(lookup.at(45.0, 0.3, 2.0).status & kReflectanceOutsideZeroToOne, 0U);
  EXPECT_NE(lookup.at(65.0, 0.3, 2.0).status & kIntensityNotPositive, 0U);
}

TEST(TableLookup, EntryWithoutABound_IsReadWithoutABound) {
  TableValues table = made_up(spaced(0, 80, 9), {0.3}, {2.0});
  table[Quantity::kErrorEstimate][4] = std::numeric_limits<double>::infinity();
  const PointResult result = TableLookup(table, with_tolerance(1e-3), "t.nc").at(42.0, 0.3, 2.0);
  EXPECT_TRUE(std::isinf(result[Quantity::kErrorEstimate]));
  EXPECT_EQ(result.status, kToleranceNotMet);
  EXPECT_TRUE(std::isfinite(result[Quantity::kDolp]));
}

TEST(TableLookup, QuantitiesThatTheTableLacks_AreNan) {
  TableValues table = made_up(spaced(0, 80, 9), {0.3}, {2.0});
  table[Quantity::kRhoI].clear();
  table[Quantity::kRhoQ].clear();
  table[Quantity::kAlbedo].clear();
  table[Quantity::kRhoErrorEstimate].clear();
  const PointResult result = TableLookup(table, with_tolerance(1e-2), "t.nc").at(42.0, 0.3, 2.0);
  EXPECT_TRUE(std::isnan(result[Quantity::kRhoI]) && std::isnan(result[Quantity::kAlbedo]) &&
              std::isnan(result[Quantity::kRhoErrorEstimate]));
  EXPECT_GT(result[Quantity::kDolp], 0.0);
  EXPECT_EQ(result.status, 0U);
}

TEST(TableLookup, VariablesThatEveryResultNeeds_AreNamedWhereTheyAreMissing) {
  const TableValues whole = made_up(spaced(0, 80, 9), {0.3}, {2.0});
  const auto message = [](const TableValues& table) {
    return error_text([&] { TableLookup(table, with_tolerance(1e-4), "t.nc"); });
  };
  for (const Quantity needed : {Quantity::kDolp, Quantity::kStokesI, Quantity::kStokesQ, Quantity::kStokesU,
                                Quantity::kStokesV, Quantity::kErrorEstimate, Quantity::kRhoI}) {
    TableValues table = whole;
    table[needed].clear();
    const std::string name = description_of(needed).name;
    EXPECT_EQ(message(table), "t.nc: the variable " + name + " is missing; lookup needs it");
  }
  TableValues table = whole;
  table.status.clear();
  EXPECT_EQ(message(table), "t.nc: the variable status is missing; lookup needs it");
  table = whole;
  table[Quantity::kDolp].clear();
  table[Quantity::kStokesU].clear();
  EXPECT_EQ(message(table), "t.nc: the variables dolp, stokes_u are missing; lookup needs them");
}

TEST(TableLookup, AValueTwice_IsRefused) {
  const TableValues table = made_up({0.0, 10.0, 10.0}, {0.3}, {2.0});
  EXPECT_THROW(TableLookup(table, with_tolerance(1e-4), "t.nc"), InputError);
}

TEST(TableLookup, QuantityThatIs0Everywhere_Is0) {
  TableValues table = made_up(spaced(0.0, 60.0, 8), spaced(0.1, 0.5, 6), spaced(1.5, 4.0, 6));
  table[Quantity::kDolpLow].assign(table[Quantity::kDolp].size(), 0.0);
  table[Quantity::kDolpHigh] = table[Quantity::kDolp];
  const PointResult result = TableLookup(table, with_tolerance(1e-4), "t").at(31.0, 0.22, 2.3);
  EXPECT_EQ(result[Quantity::kDolpLow], 0.0);
  EXPECT_GT(result[Quantity::kDolpHigh], 0.0);
  EXPECT_TRUE(std::isnan(result[Quantity::kEmissivityS]));
}

TEST(MaskingKinks, BistaticBeams_LieWhereTheLowerDirectionChanges_AndWhereNothingIsHidden) {
  const struct {
    Mode mode;
    Masking masking;
    double view_deg, azimuth_deg;
    std::vector<double> kinks_deg;
  } rows[] = {
      {Mode::kBistatic, Masking::kIntegral, 33.0, 120.0, {33.0}},
      {Mode::kBistatic, Masking::kSmith, 33.0, 120.0, {}},
      {Mode::kBistatic, Masking::kNone, 33.0, 120.0, {}},
      {Mode::kHemispherical, Masking::kIntegral, 33.0, 120.0, {}},
      // V-cavity masking is min(1, G). For a facet with the tilt alpha and the angle of incidence beta,
      // G = 2 cos(alpha) cos(theta') / cos(beta), where theta' is the larger of theta and the view zenith. There is a
      // kink where G = 1. With azimuth 180 this is at theta = 60 + view / 3 and at theta = 3 view - 180 degrees. There
      // is also a kink at theta = view if G < 1 there, as in the last row.
      {Mode::kBistatic, Masking::kVCavity, 70.0, 180.0, {30.0, 60.0 + 70.0 / 3.0}},
      {Mode::kBistatic, Masking::kVCavity, 30.0, 180.0, {70.0}},
      {Mode::kBistatic, Masking::kVCavity, 65.0, 0.0, {65.0}},
  };
  for (const auto& row : rows) {
    SceneModel scene;
    scene.surface.masking = row.masking;
    scene.geometry = {row.mode, row.view_deg, row.azimuth_deg};
    EXPECT_TRUE(masking_kinks(scene).empty());  // kinks are zeniths of the source, and the scene has no source yet
    scene.source.emplace();
    const std::vector<double> kinks_deg = masking_kinks(scene);
    ASSERT_EQ(kinks_deg.size(), row.kinks_deg.size()) << row.view_deg;
    for (std::size_t i = 0; i < kinks_deg.size(); ++i) EXPECT_NEAR(kinks_deg[i], row.kinks_deg[i], 0.02);
  }
}

}  // namespace
