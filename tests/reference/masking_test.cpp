// Masking and Mueller matrix of the reference, compared with the model's definitions, which are programmed again here.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/quadrature/exp_sinh.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>

#include "reference/moments.hpp"
#include "reference/mueller.hpp"
#include "reference/slopes.hpp"

namespace dolp::masking_test {
namespace {

using reference::IntegralMasking;
using reference::Slopes;
using reference::Zenith;
using reference::zenith_from_deg;
using std::numbers::pi;

constexpr double kRadPerDeg = pi / 180.0;
constexpr double kMaskingTolerance = 1e-13;
constexpr OpticalConstants kSteel{1.508, 0.0};

// Density of the slope t in the plane of incidence. shaders/physics/README.md has the formula.
double in_plane_density(Distribution distribution, double sigma, double q, double t) {
  if (distribution == Distribution::kGaussian) {
    return std::exp(-t * t / (2.0 * sigma * sigma)) / (std::sqrt(2.0 * pi) * sigma);
  }
  const double m2 = 2.0 * sigma * sigma;
  return std::tgamma(q - 0.5) / (std::sqrt(pi) * std::tgamma(q - 1.0) * std::sqrt(m2)) *
         std::pow(std::hypot(1.0, t / std::sqrt(m2)), 1.0 - 2.0 * q);
}

// G_1 as an integral over the tilt gamma. For q well above 3/2 the integrand is finite at both ends.
double plain_g1(Distribution distribution, double sigma, double q, double theta, double alpha) {
  boost::math::quadrature::tanh_sinh<double> rule;
  const auto density = [&](double gamma) {
    const double c = std::cos(gamma);
    return in_plane_density(distribution, sigma, q, std::tan(gamma)) / (c * c);
  };
  const double a = 0.5 * pi - theta;
  const double b = std::min(0.5 * pi, pi - 2.0 * theta + alpha);
  const auto weighted = [&](double gamma) {
    return density(gamma) * (1.0 + std::cos(theta + gamma) / std::cos(theta - alpha));
  };
  const double left = rule.integrate(density, -0.5 * pi, 0.0) + rule.integrate(density, 0.0, a);
  return left + rule.integrate(weighted, a, b);
}

TEST(ReferenceMasking, G1_MatchesIntegrationOverTheTilt) {
  constexpr double kTolerance = 1e-11;  // error of the tanh-sinh rule if the integrand peaks at an end of the range
  for (const double theta_deg : {20.0, 50.0, 75.0, 88.0}) {
    for (const double alpha_deg : {0.5, 20.0, 60.0}) {
      const double alpha = alpha_deg * kRadPerDeg;
      const Slopes cauchy(Distribution::kCauchy, {0.3, 2.5});
      EXPECT_NEAR(IntegralMasking(cauchy, zenith_from_deg(theta_deg), kMaskingTolerance)(alpha),
                  plain_g1(Distribution::kCauchy, 0.3, 2.5, theta_deg * kRadPerDeg, alpha), kTolerance);
      const Slopes gaussian(Distribution::kGaussian, {0.3, 2.0});
      EXPECT_NEAR(IntegralMasking(gaussian, zenith_from_deg(theta_deg), kMaskingTolerance)(alpha),
                  plain_g1(Distribution::kGaussian, 0.3, 2.0, theta_deg * kRadPerDeg, alpha), kTolerance);
    }
  }
}

TEST(ReferenceMasking, G1_HeavyTails_KeepTheWholeDensity) {
  // At theta = 0 G_1 is the integral of the slope density. For q near 1 much of this integral is at slopes beyond 1e16.
  constexpr double kTolerance = 1e-11;
  for (const double q : {1.001, 1.01, 1.07, 1.3, 1.5, 2.0, 50.0, 1000.0}) {
    for (const double sigma : {1e-4, 0.3, 10.0}) {
      const Slopes slopes(Distribution::kCauchy, {sigma, q});
      EXPECT_NEAR(IntegralMasking(slopes, zenith_from_deg(0.0), kMaskingTolerance)(0.3), 1.0, kTolerance) << q;
    }
  }
}

TEST(ReferenceMasking, G1_SingularDensity_MatchesIntegrationOverTheSlope) {
  constexpr double kTolerance = 1e-10;  // error of the exp-sinh rule; the integrand falls as t^(1 - 2q)
  constexpr double kSigma = 0.3, kTheta = 0.9, kAlpha = 0.4;  // for these angles the integral extends to infinity
  const double sin_theta = std::sin(kTheta), cos_theta = std::cos(kTheta);
  boost::math::quadrature::exp_sinh<double> to_infinity;
  boost::math::quadrature::tanh_sinh<double> finite;
  for (const double q : {1.05, 1.07, 1.3, 1.5, 2.0}) {
    const auto density = [&](double t) { return in_plane_density(Distribution::kCauchy, kSigma, q, t); };
    const auto weighted = [&](double t) {
      const double weight = 1.0 + (cos_theta - t * sin_theta) / (std::hypot(1.0, t) * std::cos(kTheta - kAlpha));
      return density(t) * weight;
    };
    const double slope_a = cos_theta / sin_theta;
    const double expected = 0.5 + finite.integrate(density, 0.0, slope_a) +
                            to_infinity.integrate(weighted, slope_a, std::numeric_limits<double>::infinity());
    const Zenith zenith{0.5 * pi - kTheta, cos_theta, sin_theta};
    const Slopes slopes(Distribution::kCauchy, {kSigma, q});
    EXPECT_NEAR(IntegralMasking(slopes, zenith, kMaskingTolerance)(kAlpha), expected, kTolerance) << q;
  }
}

TEST(ReferenceMasking, G1_IsWithinHalfAndOneAndFallsWithTheZenithAngle) {
  for (const Distribution distribution : {Distribution::kCauchy, Distribution::kGaussian}) {
    for (const double q : {1.1, 2.0, 7.0}) {
      const Slopes slopes(distribution, {0.4, q});
      for (const double alpha_deg : {0.0, 1.0, 30.0, 80.0}) {
        double previous = 1.0;
        for (int theta_deg = 0; theta_deg <= 90; ++theta_deg) {
          const IntegralMasking g1(slopes, zenith_from_deg(theta_deg), kMaskingTolerance);
          const double value = g1(alpha_deg * kRadPerDeg);
          EXPECT_LE(value, previous + 10.0 * kMaskingTolerance) << theta_deg << " " << alpha_deg;
          EXPECT_GE(value, 0.5 - 10.0 * kMaskingTolerance) << theta_deg << " " << alpha_deg;
          previous = value;
        }
        if (alpha_deg == 0.0) {
          EXPECT_NEAR(previous, 0.5, 10.0 * kMaskingTolerance);
        }
      }
    }
  }
}

TEST(ReferenceMasking, SmithLambda_MatchesItsDefinition) {
  // Lambda is an integral to infinity and may be large. So the tolerance of large values is relative.
  constexpr double kTolerance = 1e-9;
  boost::math::quadrature::exp_sinh<double> rule;
  for (const double sigma : {0.05, 0.4, 2.0}) {
    for (const double q : {1.7, 2.0, 2.5, 6.0}) {
      for (const Distribution distribution : {Distribution::kCauchy, Distribution::kGaussian}) {
        const Slopes slopes(distribution, {sigma, q});
        for (const double theta_deg : {30.0, 70.0, 89.0}) {
          const double mu = 1.0 / std::tan(theta_deg * kRadPerDeg);
          const double lambda =
              rule.integrate([&](double x) { return x * in_plane_density(distribution, sigma, q, mu + x); }) / mu;
          EXPECT_NEAR(reference::smith_lambda(slopes, zenith_from_deg(theta_deg)), lambda, kTolerance * (1.0 + lambda))
              << sigma << " " << q << " " << theta_deg;
        }
      }
    }
  }
}

reference::Mueller pbrdf(Masking masking, const OpticalConstants& index, const BeamAngles& angles) {
  return reference::single_bounce({Distribution::kCauchy, {0.4, 2.2}}, masking, index, angles);
}

TEST(ReferenceMueller, Reciprocity_HoldsInBothForms) {
  constexpr double kRounding = 1e-12;
  const reference::Mueller opposite = Eigen::Vector4d(1.0, 1.0, -1.0, 1.0).asDiagonal();
  const reference::Mueller same = Eigen::Vector4d(1.0, 1.0, 1.0, -1.0).asDiagonal();
  const OpticalConstants index{1.6, 0.8};
  for (const Masking masking : {Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith}) {
    for (const double delta_phi_deg : {20.0, 110.0, 179.0}) {
      const reference::Mueller f = pbrdf(masking, index, {35.0, 72.0, delta_phi_deg});
      for (const auto& [signs, back_deg] : {std::pair(opposite, -delta_phi_deg), std::pair(same, delta_phi_deg)}) {
        const reference::Mueller back = pbrdf(masking, index, {72.0, 35.0, back_deg});
        EXPECT_LE((f - signs * back.transpose() * signs).cwiseAbs().maxCoeff(), kRounding * f(0, 0)) << back_deg;
      }
    }
  }
}

TEST(ReferenceMueller, FirstRowAndColumn_MatchEquation7) {
  constexpr double kRounding = 1e-11;
  constexpr double kThetaI_deg = 40.0, kThetaR_deg = 65.0;
  const double ci = std::cos(kThetaI_deg * kRadPerDeg), si = std::sin(kThetaI_deg * kRadPerDeg);
  const double cr = std::cos(kThetaR_deg * kRadPerDeg), sr = std::sin(kThetaR_deg * kRadPerDeg);
  for (const double delta_phi_deg : {15.0, 90.0, 150.0, 180.0}) {
    const reference::Mueller f = pbrdf(Masking::kNone, kSteel, {kThetaI_deg, kThetaR_deg, delta_phi_deg});
    const double beta = 0.5 * std::acos(ci * cr + si * sr * std::cos(delta_phi_deg * kRadPerDeg));
    const double cos_alpha = (ci + cr) / (2.0 * std::cos(beta));
    const double cos_eta_i = (cos_alpha - ci * std::cos(beta)) / (si * std::sin(beta));
    const double cos_eta_r = (cos_alpha - cr * std::cos(beta)) / (sr * std::sin(beta));
    const double inside = std::asin(std::sin(beta) / kSteel.n);
    const double r_s = std::pow(std::sin(beta - inside) / std::sin(beta + inside), 2);
    const double r_p = std::pow(std::tan(beta - inside) / std::tan(beta + inside), 2);
    EXPECT_NEAR(f(0, 1) / f(0, 0), (2.0 * cos_eta_i * cos_eta_i - 1.0) * (r_s - r_p) / (r_s + r_p), kRounding);
    EXPECT_NEAR(f(1, 0) / f(0, 0), (2.0 * cos_eta_r * cos_eta_r - 1.0) * (r_s - r_p) / (r_s + r_p), kRounding);
    const double tan2 = 1.0 / (cos_alpha * cos_alpha) - 1.0;
    const double m2 = 2.0 * 0.4 * 0.4;
    const double d = 1.2 / (pi * m2 * std::pow(cos_alpha, 4)) * std::pow(1.0 + tan2 / m2, -2.2);
    EXPECT_NEAR(f(0, 0), d * 0.5 * (r_s + r_p) / 4.0, kRounding * f(0, 0));
  }
}

TEST(ReferenceMueller, Specular_IsTheMatrixOfSmoothReflection) {
  // The facet is horizontal, so the s and p directions of the facet and of the surface coincide. Let r_s and r_p be the
  // amplitude reflection coefficients. Then M22 = M33 = Re(r_s* r_p) and M32 = -M23 = Im(r_s* r_p).
  constexpr double kRounding = 1e-13;
  constexpr double kTheta_deg = 50.0;
  const OpticalConstants index{1.6, 0.8};
  const std::complex<double> n{index.n, index.k};
  const double c = std::cos(kTheta_deg * kRadPerDeg);
  const std::complex<double> w = std::sqrt(n * n - (1.0 - c * c));
  const std::complex<double> product = std::conj((c - w) / (c + w)) * (n * n * c - w) / (n * n * c + w);
  const double sum = std::norm((c - w) / (c + w)) + std::norm((n * n * c - w) / (n * n * c + w));
  const reference::Mueller f = pbrdf(Masking::kNone, index, {kTheta_deg, kTheta_deg, 180.0});
  const double scale = 0.5 * sum / f(0, 0);
  EXPECT_NEAR(f(2, 2) * scale, product.real(), kRounding);
  EXPECT_NEAR(f(3, 3) * scale, product.real(), kRounding);
  EXPECT_NEAR(f(3, 2) * scale, product.imag(), kRounding);
  EXPECT_NEAR(f(2, 3) * scale, -product.imag(), kRounding);
  EXPECT_NEAR(f(0, 2) * scale, 0.0, kRounding);
}

}  // namespace
}  // namespace dolp::masking_test
