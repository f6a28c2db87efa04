// The reference evaluator's pBRDF of light that bounces several times in V-grooves.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

#include "reference/moments.hpp"
#include "reference/mueller.hpp"
#include "reference/reference_evaluator.hpp"

namespace dolp::bounces_test {
namespace {

using boost::math::quadrature::gauss;
using std::numbers::pi;

constexpr double kRadPerDeg = pi / 180.0;
constexpr double kTheta_deg = 40.0;
constexpr OpticalConstants kPaint{1.5, 0.0};
constexpr OpticalConstants kMetal{10.0, 60.0};

using reference::Mueller;

const reference::Slopes kSlopes(Distribution::kCauchy, {0.4, 2.0});

constexpr std::array<BeamAngles, 7> kPairs{{{0.0, 40.0, 20.0},
                                            {10.0, 62.0, 100.0},
                                            {40.0, 41.0, 179.0},
                                            {60.0, 60.0, 0.0},
                                            {75.0, 20.0, 150.0},
                                            {85.0, 80.0, 181.0},
                                            {89.0, 89.5, 30.0}}};

TEST(ReferenceBounces, FirstBounce_IsSingleScattering) {
  constexpr double kTolerance = 1e-12;
  for (const BeamAngles& a : kPairs) {
    const Mueller once = reference::light_of_bounces(kSlopes, kMetal, a, 1);
    const Mueller single = reference::single_bounce(kSlopes, Masking::kVCavity, kMetal, a);
    ASSERT_GT(single(0, 0), 0.0);
    EXPECT_LE((once - single).cwiseAbs().maxCoeff(), kTolerance * single(0, 0)) << a.theta_i_deg;
  }
}

TEST(ReferenceBounces, EachNumber_IsReciprocal) {
  constexpr double kTolerance = 1e-12;
  const Mueller signs = Eigen::Vector4d(1.0, 1.0, -1.0, 1.0).asDiagonal();
  std::array<double, 6> largest{};
  for (const BeamAngles& a : kPairs) {
    for (const int bounces : {1, 2, 3, 4, 5}) {
      const BeamAngles opposite{a.theta_r_deg, a.theta_i_deg, -a.delta_phi_deg};
      const Mueller f = reference::light_of_bounces(kSlopes, kMetal, a, bounces);
      const Mueller back = reference::light_of_bounces(kSlopes, kMetal, opposite, bounces);
      EXPECT_LE((f - signs * back.transpose() * signs).cwiseAbs().maxCoeff(), kTolerance * f(0, 0) + 1e-30);
      double& most = largest.at(static_cast<std::size_t>(bounces));
      most = std::max(most, f(0, 0));
    }
  }
  for (const int bounces : {1, 2, 3, 4, 5}) EXPECT_GT(largest.at(static_cast<std::size_t>(bounces)), 0.0) << bounces;
}

// Smallest over largest eigenvalue of Cloude's coherency matrix. A realisable Mueller matrix has no negative
// eigenvalue.
double smallest_eigenvalue(const Mueller& m) {
  using Complex = std::complex<double>;
  const Complex i(0.0, 1.0);
  std::array<Eigen::Matrix2cd, 4> pauli;
  pauli[0] << 1.0, 0.0, 0.0, 1.0;
  pauli[1] << 1.0, 0.0, 0.0, -1.0;
  pauli[2] << 0.0, 1.0, 1.0, 0.0;
  pauli[3] << 0.0, -i, i, 0.0;
  Eigen::Matrix4cd coherency = Eigen::Matrix4cd::Zero();
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) {
      for (int e = 0; e < 16; ++e) {
        coherency(e / 4, e % 4) +=
            m.data()[4 * a + b] * pauli[a](e / 8, e / 2 % 2) * std::conj(pauli[b](e / 4 % 2, e % 2));
      }
    }
  }
  const Eigen::Vector4d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4cd>(coherency).eigenvalues();
  return values[0] / values[3];
}

TEST(ReferenceBounces, Sum_IsPhysical) {
  constexpr double kRounding = 1e-13;
  const reference::Slopes slopes(Distribution::kCauchy, {0.9, 1.7});
  for (const OpticalConstants index : {kPaint, kMetal}) {
    for (const BeamAngles& a : kPairs) {
      const reference::BouncesSum sum = reference::all_bounces(slopes, index, a);
      EXPECT_GE(smallest_eigenvalue(sum.matrix), -kRounding) << a.theta_i_deg << " " << a.theta_r_deg;
      EXPECT_LE(sum.error, 1e-6 * sum.matrix(0, 0));
    }
  }
}

// The pBRDF diverges in the mirror direction: at every azimuth of grooves there is a slope that sends light into this
// direction after two bounces. For light at zenith 0 this slope is 45 degrees, and the pBRDF diverges as well.
TEST(ReferenceBounces, MirrorDirection_IsWhereTwoBouncesDiverge) {
  const auto twice = [](double theta_r_deg, double delta_phi_deg) {
    return reference::light_of_bounces(kSlopes, kPaint, {kTheta_deg, theta_r_deg, delta_phi_deg}, 2)(0, 0);
  };
  EXPECT_TRUE(std::isnan(twice(kTheta_deg, 180.0)));
  EXPECT_TRUE(std::isnan(reference::all_bounces(kSlopes, kPaint, {kTheta_deg, kTheta_deg, 180.0}).matrix(0, 0)));
  EXPECT_TRUE(std::isnan(reference::all_bounces(kSlopes, kPaint, {0.0, 0.0, 90.0}).matrix(0, 0)));
  EXPECT_NEAR(twice(kTheta_deg + 1e-4, 180.0) / twice(kTheta_deg + 1e-3, 180.0), 10.0, 1e-2);
  EXPECT_NEAR(twice(kTheta_deg + 1e-3, 0.0) / twice(kTheta_deg, 0.0), 1.0, 1e-3);
  EXPECT_GT(twice(kTheta_deg, 0.0), 0.0);
}

TEST(ReferenceBounces, ScatterOfTheEvaluator_IsTheSum) {
  ScatteringRequest request;
  request.masking = Masking::kVCavity;
  request.scattering = Scattering::kMultiple;
  request.angles = {kPairs[3]};
  request.shapes = {{0.4, 2.0}};
  request.optics = {kMetal};
  request.entries = {{}};
  const ScatteringMatrix matrix = ReferenceEvaluator().scatter(request, {}).at(0);
  EXPECT_EQ(Mueller(matrix.m.data()), reference::all_bounces(kSlopes, kMetal, {60.0, 60.0, 0.0}).matrix);
}

// Integrates the elements 00 and 01 of all_bounces(), which is the pBRDF times both cosines, over the
// horizontal components x and y of the direction of reflection. The solid angle is dx dy / cos(theta_r). The polar
// coordinates in the plane of x and y have their centre at the mirror direction, where the pBRDF diverges.
std::complex<double> hemispherical(const reference::Slopes& slopes, const OpticalConstants& index, double theta_deg) {
  constexpr int kSectors = 12, kRings = 3;
  const double centre = -std::sin(theta_deg * kRadPerDeg);
  std::complex<double> total;
  for (int sector = 0; sector < kSectors; ++sector) {
    for (int ring = 0; ring < kRings; ++ring) {
      const auto in_sector = [&](double chi) {
        const double reach = std::sqrt(1.0 - std::pow(centre * std::sin(chi), 2)) - centre * std::cos(chi);
        // At the horizon, y = 1, the factor 1 - y of the area cancels the infinite 1/cosine.
        const auto at = [&](double y) {
          const double distance = reach * y * (2.0 - y);
          const double x = centre + distance * std::cos(chi), across = distance * std::sin(chi);
          const double sine = std::hypot(x, across);
          const double cosine = std::sqrt((1.0 - sine) * (1.0 + sine));
          const BeamAngles angles{theta_deg, std::atan2(sine, cosine) / kRadPerDeg, std::atan2(across, x) / kRadPerDeg};
          const Mueller f = reference::all_bounces(slopes, index, angles).matrix;
          return std::complex(f(0, 0), f(0, 1)) / cosine * distance * reach * 2.0 * (1.0 - y);
        };
        return gauss<double, 7>::integrate(at, static_cast<double>(ring) / kRings, (ring + 1.0) / kRings);
      };
      total += 2.0 * gauss<double, 3>::integrate(in_sector, pi * sector / kSectors, pi * (sector + 1) / kSectors);
    }
  }
  return total;
}

TEST(ReferenceBounces, HemisphericalIntegral_IsTheMoments) {
  constexpr double kPlainTolerance = 1e-4;
  struct Row {
    reference::Slopes slopes;
    double theta_deg;
    OpticalConstants index;
  };
  for (const Row& row : {Row{{Distribution::kCauchy, {0.3, 2.0}}, 60.0, kPaint},
                         Row{{Distribution::kGaussian, {0.5, 2.0}}, 30.0, kMetal}}) {
    const Moments m = reference::groove_moments(row.slopes, row.theta_deg, row.index, {.relative_tolerance = 1e-7});
    const std::complex<double> plain = hemispherical(row.slopes, row.index, row.theta_deg);
    EXPECT_NEAR(plain.real(), m.r_i, kPlainTolerance * m.r_i);
    EXPECT_NEAR(plain.imag(), m.r_q, kPlainTolerance * m.r_i);
  }
}

}  // namespace
}  // namespace dolp::bounces_test
