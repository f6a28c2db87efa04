// groove.glsl: many bounces of a ray taken as one, against every one of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "physics_text.hpp"

namespace dolp {
namespace {

// Over the cosine, as in host/plan/error_bounds.cpp.
constexpr double kManyBouncesError = 1e-3;
constexpr double kVeryManyBouncesError = 1e-2;
constexpr double kLeast = 1e-15;
constexpr double kVeryManyBouncesSlope = 1024.0 * 2.0 / std::numbers::pi;

using Text = tested_double::Text;

/// The light that leaves a groove of slope t, over the beam, from its bounces one by one.
double reflected_bounce_by_bounce(Text& text, const Text::ThetaNode& theta, const Text::IndexNode& index,
                                  double t, double x) {
  const double u = theta.s * x;
  const double b = theta.s * std::sqrt(1.0 - x * x);
  const double a = std::hypot(theta.c, u);
  const double psi = std::atan2(u, theta.c);
  const double gamma = std::atan2(1.0, t);
  const double first = a * std::sin(psi + gamma);
  const double least = std::max(a * std::sin(psi - gamma), 0.0);
  glm::dvec4 natural(1.0, 0.0, 0.0, 0.0);
  double share = 1.0;
  for (int k = 1; share > 0.0; ++k) {
    const double chi = psi + (2 * k - 1) * gamma;
    const double cos_beta = a * std::sin(chi);
    const glm::dvec2 twice = text.doubled_angle(a * std::cos(chi), b * cos_beta);
    const auto by = text.bounce(index, cos_beta, 1.0 - cos_beta * cos_beta, 0);
    natural += share * (text.bounced(by, twice, natural) - natural);
    const double next = a * std::sin(psi + (2 * k + 1) * gamma);
    share = std::clamp((std::min(next, first) - least) / (first - least), 0.0, 1.0);
  }
  return natural.x;
}

TEST(GrooveText, ManyBouncesTakenAsOne_AreWithinTheirBound) {
  Text text;
  for (const auto& [n, k] : {std::pair{1.5, 0.0}, {2.8, 3.3}, {10.0, 60.0}, {30.0, 150.0}, {0.3, 40.0}}) {
    const std::complex<double> n2m1 = std::complex<double>(n, k) * std::complex<double>(n, k) - 1.0;
    Text::IndexNode index{};
    index.n2m1_re = n2m1.real();
    index.n2m1_im = n2m1.imag();
    for (const double theta_deg : {0.0, 30.0, 60.0, 80.0}) {
      const double angle = theta_deg * std::numbers::pi / 180.0;
      Text::ThetaNode theta{};
      theta.c = std::cos(angle);
      theta.s = std::sin(angle);
      for (const double x : {-0.9, -0.2, 0.3, 0.95}) {
        for (double slope = 12.0; slope < 20000.0; slope *= 1.9) {
          // The slopes of a few per cent average over where in a group a ray ends.
          double difference = 0.0;
          double found = 0.0;
          constexpr int kSlopes = 20;
          for (int i = 0; i < kSlopes; ++i) {
            const double t = slope * (1.0 + 0.2 * (i + 0.5) / kSlopes);
            if (theta.c + theta.s * t * x <= 0.0) continue;
            const auto moments = text.reflected_in_groove(Text::RuleNode{}, theta, index, t, x, std::sqrt(1.0 - x * x));
            found += moments.x / moments.z / kSlopes;
            difference += moments.x / moments.z - reflected_bounce_by_bounce(text, theta, index, t, x);
          }
          EXPECT_LE(std::abs(difference / kSlopes),
                    slope < kVeryManyBouncesSlope ? kManyBouncesError : kVeryManyBouncesError)
              << n << " + " << k << "i, theta " << theta_deg << ", x " << x << ", slope " << slope;
          // What is found to be little is little.
          EXPECT_LE(std::abs(difference / kSlopes), found + kLeast)
              << n << " + " << k << "i, theta " << theta_deg << ", x " << x << ", slope " << slope;
        }
      }
    }
  }
}

}  // namespace
}  // namespace dolp
