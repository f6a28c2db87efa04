// The plan: exact directions, and loops that stay below what drivers allow.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "model/angles.hpp"
#include "plan/kernel_data.hpp"
#include "plan/rule.hpp"
#include "plan/rule_nodes.hpp"

namespace dolp {
namespace {

constexpr std::array kMaskings = {Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith};
constexpr std::array kDistributions = {Distribution::kCauchy, Distribution::kGaussian};
constexpr std::array kHardDirectionsDeg = {0.0,  1e-6, 12.857142857, 12.9, 18.0,  30.0, 30.2,
                                           44.9, 45.0, 45.1,         60.0, 89.99, 90.0};
constexpr OpticalConstants kDielectric{1.508, 0.0};

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
  constexpr double kTolerance = 5e-16;  // pi times the rounding of an angle over 180 degrees, and that of the result
  for (double angle_deg = -90.0; angle_deg <= 360.0; angle_deg += 0.37) {
    const long double angle = angle_deg * std::numbers::pi_v<long double> / 180.0L;
    EXPECT_NEAR(cos_sin_deg(angle_deg).cos, static_cast<double>(std::cos(angle)), kTolerance) << angle_deg;
    EXPECT_NEAR(cos_sin_deg(angle_deg).sin, static_cast<double>(std::sin(angle)), kTolerance) << angle_deg;
  }
}

// ---- Kernel data ---------------------------------------------------------------------------------------------------

// All hard directions with an ordinary, an absorbing and several totally reflecting indices.
MomentsRequest hard_request(Distribution distribution, Masking masking, double tolerance, bool total_reflection) {
  MomentsRequest request;
  request.distribution = distribution;
  request.masking = masking;
  request.tolerance = tolerance;
  request.theta_deg.assign(kHardDirectionsDeg.begin(), kHardDirectionsDeg.end());
  request.sigma = {0.3, 1e-3, 5.0};
  request.q = {2.0, 1.6, 45.0};
  request.indices = {kDielectric, {27.0, 90.0}};
  if (total_reflection) {
    for (const double n : {0.999, 0.8, std::numbers::sqrt2 / 2.0, 0.5, 0.1}) request.indices.push_back({n, 0.0});
  }
  return request;
}

// All loops of an invocation count toward what a driver allows.
constexpr double kDriverLimit = 65535.0;

TEST(KernelDataOrders, EveryTolerance_StaysBelowTheDriversLoopLimit) {
  for (const Distribution distribution : kDistributions) {
    for (const Masking masking : kMaskings) {
      for (const bool total_reflection : {false, true}) {
        double most = 0.0;
        for (int exponent = 2; exponent <= 15; ++exponent) {
          const double tolerance = std::pow(10.0, -exponent);
          const KernelData data = kernel_data(hard_request(distribution, masking, tolerance, total_reflection));
          const double iterations = worst_iterations(data);
          EXPECT_GT(iterations, 0.0);
          EXPECT_LT(iterations, kDriverLimit) << tolerance;
          most = std::max(most, iterations);
        }
        std::printf("%s %s%s: at most %.0f iterations\n", name_of(distribution), name_of(masking),
                    total_reflection ? ", total reflection" : "", most);
      }
    }
  }
}

TEST(KernelDataOrders, AllBounces_StayBelowTheDriversLoopLimit) {
  for (const bool total_reflection : {false, true}) {
    for (int exponent = 2; exponent <= 15; ++exponent) {
      MomentsRequest request =
          hard_request(Distribution::kCauchy, Masking::kVCavity, std::pow(10.0, -exponent), total_reflection);
      request.scattering = Scattering::kMultiple;
      const KernelData data = kernel_data(request);
      EXPECT_LT(worst_iterations(data), kDriverLimit) << exponent;
    }
  }
}

// One loop over the nodes, in each of which a small Gauss rule.
TEST(MaskingTable, ItsLoops_StayBelowTheDriversLimit) {
  constexpr int kTableOrderAtMost = 8;
  EXPECT_LT(DOLP_MASKING_NODES(DOLP_MASKING_CELL_BITS_DOUBLE) * (1.0 + kTableOrderAtMost), kDriverLimit);
}

// Chebyshev polynomials are of size 1, so that no degree hides behind another.
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
