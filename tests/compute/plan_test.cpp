// Exact directions, and loops below the limits of drivers.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "model/angles.hpp"
#include "plan/kernel_data.hpp"
#include "plan/rule.hpp"

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
  // pi times the rounding of an angle over 180 degrees, plus the rounding of the result
  constexpr double kTolerance = 5e-16;
  for (double angle_deg = -90.0; angle_deg <= 360.0; angle_deg += 0.37) {
    const long double angle = angle_deg * std::numbers::pi_v<long double> / 180.0L;
    EXPECT_NEAR(cos_sin_deg(angle_deg).cos, static_cast<double>(std::cos(angle)), kTolerance) << angle_deg;
    EXPECT_NEAR(cos_sin_deg(angle_deg).sin, static_cast<double>(std::sin(angle)), kTolerance) << angle_deg;
  }
}

// ---- Loops ---------------------------------------------------------------------------------------------------------

// lavapipe stops an invocation without notice after this many iterations of all its loops.
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
      for (int masking = 0; masking <= 4; ++masking) {  // the last one: all bounces
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
  // The masking table: one loop over the nodes, with a small Gauss rule in each.
  constexpr double kTableOrderAtMost = 8.0;
  EXPECT_LT(DOLP_MASKING_NODES(DOLP_MASKING_CELL_BITS_DOUBLE) * (1.0 + kTableOrderAtMost), kDriverLimit);
}

// Chebyshev polynomials have a size of 1, so no degree hides another.
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

}  // namespace
}  // namespace dolp
