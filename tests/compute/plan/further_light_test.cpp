// The estimate of the light after the first bounce, against the moments of one bounce and of all bounces.
#include "plan/further_light.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "model/angles.hpp"
#include "model/moments.hpp"

namespace dolp::further_light_test {
namespace {

MomentsRequest request_for(Distribution distribution, Scattering scattering) {
  MomentsRequest request;
  request.distribution = distribution;
  request.masking = Masking::kVCavity;
  request.scattering = scattering;
  request.tolerance = 1e-6;
  request.precision = Precision::kDouble;
  request.theta_deg = {0.0, 30.0, 60.0, 75.0, 85.0};
  request.optics = {{1.5, 0.1}, {3.4, 0.01}, {10.0, 60.0}, {0.6, 0.3}};
  request.shapes = shape_product(std::array{0.1, 0.3, 0.8}, std::array{1.8, 3.0, 6.0});
  request.set_grid();
  return request;
}

std::vector<Moments> moments_for(Distribution distribution, Scattering scattering) {
  CpuEvaluator evaluator;
  return evaluator.evaluate(request_for(distribution, scattering), {});
}

// Errors relative to i: the rays have four slopes and four azimuths on each smooth piece. Among 1,865 random entries
// the error was 1 % in the median, 5 % at the 90th percentile and at most 33 %. Large errors have a heavy tail of
// slopes and a zenith above 80 degrees.
constexpr double kAccuracy = 0.4;
constexpr double kUsualAccuracy = 0.1;
constexpr double kLeastUsualShare = 0.85;
constexpr double kLeastLost = 1e-4;  // less lost light has no digits in the difference of two moments

TEST(FurtherLight, AnyShapeAndMaterial_IsWhatAllBouncesAddToOne) {
  for (const Distribution distribution : {Distribution::kCauchy, Distribution::kGaussian}) {
    const MomentsRequest request = request_for(distribution, Scattering::kSingle);
    const std::vector<Moments> single = moments_for(distribution, Scattering::kSingle);
    const std::vector<Moments> all = moments_for(distribution, Scattering::kMultiple);
    std::size_t compared = 0, usual = 0;
    for (std::size_t i = 0; i < single.size(); ++i) {
      const MomentsPoint point = request[i];
      const double lost = cos_sin_deg(point.theta_deg).cos - single[i].albedo;
      if (lost < kLeastLost) continue;
      ++compared;
      const double expected = (all[i].r_i - single[i].r_i) / lost;
      const FurtherLight light = further_light(distribution, point.theta_deg, point.shape, GrooveFacet(point.index));
      EXPECT_NEAR(light.i, expected, kAccuracy * expected) << "entry " << i;
      const double q = (all[i].r_q - single[i].r_q) / lost;
      EXPECT_NEAR(light.q, q, kAccuracy * expected) << "entry " << i;
      const double error = std::max(std::abs(light.i - expected), std::abs(light.q - q));
      usual += error < kUsualAccuracy * expected ? 1 : 0;
    }
    EXPECT_GT(compared, single.size() / 2);
    EXPECT_GT(static_cast<double>(usual), kLeastUsualShare * static_cast<double>(compared));
  }
}

TEST(FurtherLight, ShapesAtTheEndsOfTheirRanges_AreNumbersFromZeroToOne) {
  const GrooveFacet facet({1.5, 0.1});
  for (const double theta_deg : {0.0, 1e-6, 45.0, 90.0}) {
    for (const double sigma : {1e-4, 10.0}) {
      for (const double q : {1.001, 2.0, 1e4}) {
        for (const Distribution distribution : {Distribution::kCauchy, Distribution::kGaussian}) {
          const FurtherLight light = further_light(distribution, theta_deg, {sigma, q}, facet);
          EXPECT_GE(light.i, 0.0) << theta_deg << " " << sigma << " " << q;
          EXPECT_LE(light.i + std::abs(light.q), 1.0) << theta_deg << " " << sigma << " " << q;
        }
      }
    }
  }
}

}  // namespace
}  // namespace dolp::further_light_test
