// Polarised diffuse reflection, compared with sums over directions that this file computes itself.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "radiometry/diffuse.hpp"

namespace dolp::diffuse_test {
namespace {

constexpr double kPi = std::numbers::pi;

/// Transmittances T_s and T_p of the smooth surface, by Fresnel's equations.
std::pair<double, double> transmittances(std::complex<double> n, double cosine) {
  const std::complex<double> w = std::sqrt(n * n - 1.0 + cosine * cosine);
  const std::complex<double> s = (cosine - w) / (cosine + w), p = (n * n * cosine - w) / (n * n * cosine + w);
  return {1.0 - std::norm(s), 1.0 - std::norm(p)};
}

Surface paint(double n, double k, double c, DiffusePolarisation polarisation) {
  Surface surface;
  surface.material.constant = {n, k};
  surface.diffuse = 0.3;
  surface.diffuse_exponent = c;
  surface.diffuse_polarisation = polarisation;
  return surface;
}

TEST(DiffuseReflection, RhoIsTheHemisphericalSumOfTheBeams) {
  struct Case {
    double n, k, c;
  };
  for (const Case& own :
       {Case{1.5, 0.0, -0.5}, {1.5, 0.3, 0.0}, {2.4, 0.0, -0.9}, {8.0, 20.0, -0.3}, {0.7, 0.0, -0.2}}) {
    const std::complex<double> n(own.n, own.k);
    const Surface surface = paint(own.n, own.k, own.c, DiffusePolarisation::kTransmission);
    const DiffuseReflection diffuse(surface, surface.material.constant);
    const double normal = transmittances(n, 1.0).first;
    for (const double cosine : {1.0, 0.7, 0.2, 0.01}) {
      const auto [out_s, out_p] = transmittances(n, cosine);
      double i = 0.0, q = 0.0;
      constexpr int kSteps = 200000;
      for (int step = 0; step < kSteps; ++step) {  // with mu = x^5 the integrand is smooth at mu = 0
        const double x = (step + 0.5) / kSteps, mu = std::pow(x, 5.0);
        const auto [in_s, in_p] = transmittances(n, mu);
        const double f = 0.3 / kPi * std::pow(mu * cosine, own.c) * 0.5 * (in_s + in_p) / (normal * normal);
        const double weight = 2.0 * kPi * mu * 5.0 * std::pow(x, 4.0) / kSteps;
        i += weight * f * 0.5 * (out_s + out_p);
        q += weight * f * 0.5 * (out_s - out_p);
      }
      const DiffuseLight rho = diffuse.rho(cosine);
      EXPECT_NEAR(rho.i, i, 1e-6 * i + 1e-15) << own.n << " " << own.k << " at " << cosine;
      EXPECT_NEAR(rho.q, q, 1e-6 * i + 1e-15) << own.n << " " << own.k << " at " << cosine;
    }
    EXPECT_LT(diffuse.rho(0.8).q, 0.0);  // transmitted light is p-polarised
    EXPECT_NEAR(diffuse.beam(0.6, 0.3).i / 0.6, diffuse.beam(0.3, 0.6).i / 0.3, 1e-14);  // reciprocal
  }
}

TEST(DiffuseReflection, MediumLikeAir_IsUnpolarised) {
  const Surface air = paint(1.0, 0.0, -0.4, DiffusePolarisation::kTransmission);
  const Surface plain = paint(1.0, 0.0, -0.4, DiffusePolarisation::kNone);
  const DiffuseReflection polarised(air, air.material.constant), unpolarised(plain, plain.material.constant);
  for (const double cosine : {1.0, 0.5, 0.1}) {
    EXPECT_NEAR(polarised.rho(cosine).i, unpolarised.rho(cosine).i, 1e-13);
    EXPECT_NEAR(polarised.rho(cosine).q, 0.0, 1e-15);
    EXPECT_NEAR(polarised.beam(0.3, cosine).i, unpolarised.beam(0.3, cosine).i, 1e-14);
  }
}

TEST(DiffuseReflection, MeanOfASky_IsWeightedWithItsTransmission) {
  const Surface surface = paint(1.5, 0.1, -0.3, DiffusePolarisation::kTransmission);
  const DiffuseReflection diffuse(surface, surface.material.constant);
  const SkyNodes nodes({0.0, 60.0, 90.0});
  Eigen::VectorXd sky(static_cast<Eigen::Index>(nodes.zenith_deg().size()));
  const auto radiance = [](double cosine) { return 1.0 + 2.0 * cosine * cosine; };
  for (Eigen::Index i = 0; i < sky.size(); ++i)
    sky[i] = radiance(std::cos(nodes.zenith_deg()[static_cast<std::size_t>(i)] * kPi / 180.0));
  double sum = 0.0, weights = 0.0;
  constexpr int kSteps = 100000;
  for (int step = 0; step < kSteps; ++step) {
    const double x = (step + 0.5) / kSteps, mu = std::pow(x, 5.0);
    const auto [s, p] = transmittances({1.5, 0.1}, mu);
    const double weight = std::pow(mu, 0.7) * (s + p) * std::pow(x, 4.0);
    sum += weight * radiance(mu);
    weights += weight;
  }
  EXPECT_NEAR(diffuse.sky_mean(nodes, sky).value, sum / weights, 1e-6);
}

TEST(DiffuseReflection, GrazingView_HasALimit) {
  const Surface surface = paint(1.5, 0.0, -0.9, DiffusePolarisation::kTransmission);
  EXPECT_FALSE(diffuse_diverges(surface));
  EXPECT_TRUE(diffuse_diverges(paint(1.5, 0.0, -0.9, DiffusePolarisation::kNone)));
  const DiffuseReflection diffuse(surface, surface.material.constant);
  EXPECT_EQ(diffuse.rho(0.0).i, 0.0);
  EXPECT_NEAR(diffuse.rho(1e-8).i / diffuse.rho(1e-6).i, std::pow(1e-2, 0.1), 1e-4);  // rho ~ cos^(0.1)
}

}  // namespace
}  // namespace dolp::diffuse_test
