// Which entries need a line or a cusp more, and that they alone get it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "model/angles.hpp"
#include "plan/kernel_data.hpp"
#include "plan/rule.hpp"

namespace dolp {
namespace {

constexpr std::array kDistributions = {Distribution::kCauchy, Distribution::kGaussian};
constexpr double kFewDigits = 5.0;
constexpr double kManyDigits = 14.0;
constexpr OpticalConstants kDielectric{1.508, 0.0};

TEST(NeedsLine, WhatHasNone_NeverDoes) {
  for (double digits = 2.0; digits <= 16.0; digits += 1.0) {
    for (const Masking masking : {Masking::kNone, Masking::kVCavity}) {
      for (const Distribution distribution : kDistributions) {
        EXPECT_FALSE(needs_line(distribution, masking, {1.0, 1.2}, digits, std::pow(10.0, -digits)));
      }
    }
    for (const double q : {2.0, 3.0, 10.0}) {  // theta_r^(2q-2) is smooth
      EXPECT_FALSE(needs_line(Distribution::kCauchy, Masking::kSmith, {1.0, q}, digits, std::pow(10.0, -digits))) << q;
    }
  }
}

// What is needed for a tolerance is needed for tighter ones; a rougher surface does not need it less. Rough surfaces
// with heavy tails do at tight tolerances, narrow ones with light tails never.
TEST(NeedsLine, TighterToleranceOrRoughness_NeverTakesItAway) {
  constexpr double kTightDecades = 10.0;
  for (const Distribution distribution : kDistributions) {
    for (const Masking masking : {Masking::kIntegral, Masking::kSmith}) {
      const auto needed = [&](const SlopeShape& shape, double decades) {
        const double tolerance = std::pow(10.0, -decades);
        return needs_line(distribution, masking, shape, rule_digits(rule_model(masking), tolerance), tolerance);
      };
      EXPECT_TRUE(needed({2.0, 1.6}, kTightDecades)) << name_of(distribution) << " " << name_of(masking);
      EXPECT_FALSE(needed({1e-3, 10.5}, kTightDecades)) << name_of(distribution) << " " << name_of(masking);
      for (const double q : {1.55, 1.6, 1.75, 2.4, 3.3}) {
        for (double sigma = 0.001; sigma < 5.0; sigma *= 1.7) {
          for (double decades = 2.0; decades <= kTightDecades; decades += 0.25) {
            if (!needed({sigma, q}, decades)) continue;
            EXPECT_TRUE(needed({sigma, q}, decades + 0.25)) << q << " " << sigma << " " << decades;
            EXPECT_TRUE(needed({1.7 * sigma, q}, decades)) << q << " " << sigma << " " << decades;
          }
        }
      }
    }
  }
}

// log10 of C(q) width^(2q-2), the part of smith's L that is not smooth at theta_r = 0, up to a constant and to what the
// rules feel of it, n^-2q with n nodes. Widths beyond 1 no longer count in the first, but L then varies over slopes of
// 1 / width, which have as many nodes fewer, down to the fewest that count.
TEST(CuspDigits, Size_GoesAsTheTailAtSlopeOne) {
  const auto size = [](double sigma, double q) {
    return cusp_digits(Distribution::kCauchy, Masking::kSmith, {sigma, q}, kFewDigits);
  };
  for (const double q : {1.6, 1.75, 2.4, 3.3}) {
    EXPECT_NEAR(size(0.02, q) - size(0.002, q), 2.0 * q - 2.0, 1e-12);
    const double wide = 1.0 / std::numbers::sqrt2;
    EXPECT_NEAR(size(3.0 * wide, q) - size(wide, q), 2.0 * q * std::log10(3.0), 1e-12);
    EXPECT_EQ(size(4.0, q), size(5.0, q));
    EXPECT_GT(size(1e-20, q), -1000.0);
    // more digits have more nodes, which feel less of it
    EXPECT_LT(cusp_digits(Distribution::kCauchy, Masking::kSmith, {1.0, q}, kManyDigits), size(1.0, q));
  }
  // the nearer q is to an integer, the smaller: by its distance, but for what 0.01 of q is felt less
  EXPECT_NEAR(size(5.0, 2.01) - size(5.0, 2.0001), 2.0, 0.05);
  EXPECT_NEAR(size(5.0, 1.99), size(5.0, 2.01), 0.1);
}

// All derivatives of the gaussian's L vanish there; what stands for it is exp(-1/width^2), L at 45 degrees.
TEST(CuspDigits, OfTheGaussian_AreThoseOfItsTailAtSlopeOne) {
  const auto size = [](double sigma, double digits) {
    return cusp_digits(Distribution::kGaussian, Masking::kSmith, {sigma, 1.6}, digits);
  };
  EXPECT_NEAR(size(0.2, kFewDigits) - size(0.1, kFewDigits), (50.0 - 12.5) / std::numbers::ln10, 1e-12);
  EXPECT_LT(size(0.1, kManyDigits), -kManyDigits);  // nothing at any digits
  EXPECT_GT(size(2.0, kFewDigits), -kFewDigits);
  EXPECT_LT(size(0.5, kManyDigits), size(0.5, kFewDigits));
}

TEST(CuspDigits, NoCusp_IsBelowAnyDigits) {
  constexpr double kKernelsLimit = -100.0;  // ShapeNode::cusp_digits
  for (const double q : {2.0, 3.0, 7.0}) {
    EXPECT_LT(cusp_digits(Distribution::kCauchy, Masking::kSmith, {1.0, q}, kFewDigits), kKernelsLimit);
  }
  EXPECT_LT(cusp_digits(Distribution::kGaussian, Masking::kSmith, {0.04, 1.6}, kFewDigits), kKernelsLimit);
  EXPECT_LT(cusp_digits(Distribution::kCauchy, Masking::kIntegral, {1.0, 1.6}, kFewDigits), kKernelsLimit);
}

TEST(KernelDataLines, OnlyTheShapesThatNeedThem_GetDirectionsOfTheirOwn) {
  MomentsRequest request;
  request.masking = Masking::kIntegral;
  request.tolerance = 1e-8;
  request.theta_deg = {20.0, 70.0};
  request.indices = {kDielectric};
  request.sigma = {1.0, 1e-3};
  request.q = {1.2, 10.0};
  const KernelData data = kernel_data(request);
  ASSERT_EQ(data.thetas.size(), 4U);
  for (std::size_t i = 0; i < data.size(); ++i) {
    const std::uint32_t theta = data[i].theta;
    const bool is_needed =
        needs_line(request.distribution, request.masking, request[i].shape, data.rule.digits, request.tolerance);
    EXPECT_EQ(data.pieces[theta].has_split_line, is_needed) << i;
    EXPECT_EQ(data.thetas[theta].c, cos_sin_deg(request[i].theta_deg).cos);
  }
  // sigma 1 with q 1.2 and sigma 0.001 with q 10 of each direction
  for (const std::size_t first : {0U, 4U}) {
    EXPECT_TRUE(data.pieces[data[first].theta].has_split_line);
    EXPECT_FALSE(data.pieces[data[first + 3].theta].has_split_line);
    EXPECT_GT(data.pieces[data[first].theta].count, data.pieces[data[first + 3].theta].count);
  }
}

}  // namespace
}  // namespace dolp
