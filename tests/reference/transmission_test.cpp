// The integral of polarised diffuse reflection: two quadratures that share no formula, and closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/transmission.hpp"
#include "reference/moments.hpp"

namespace dolp::transmission_test {
namespace {

constexpr double kMostError = 1e-11;  // largest stated error of both quadratures, in units of the integral for g = 1
// An elevation near the vertical rounds by 2e-16. A medium with n = 0.02 lets light through only there.
constexpr double kElevationRounding = 4e-15;
const SkyFunction kOne{[](double) { return 1.0; }, {}};

/// Radiance with a corner at 40 degrees that rises steeply toward the horizon, as in a layered sky.
double layered(double zenith_deg) {
  const double cosine = std::max(std::cos(zenith_deg * std::numbers::pi / 180.0), 1e-9);
  return 2.0 - std::pow(0.7, 1.0 / cosine) + 0.01 * std::abs(zenith_deg - 40.0);
}
const SkyFunction kLayered{layered, {0.0, 40.0, 75.0, 86.0, 89.0, 89.75, 90.0}};

TEST(Transmission, KinksOfTotalReflection_BothQuadraturesAgreeWithinTheirErrors) {
  for (const double n : {0.02, 0.5, 0.9, 0.999999, 1.0, 1.5, 4.0}) {
    for (const double k : {0.0, 1e-14, 1e-9, 1e-5, 1e-3, 0.1, 3.0}) {
      for (const double power : {0.05, 0.7, 1.0}) {
        const FacetOptics optics{n, k};
        const double unit = transmission_integral(optics, power, kOne).value;
        for (const SkyFunction* sky : {&kOne, &kLayered}) {
          const Estimate own = transmission_integral(optics, power, *sky);
          const Estimate right = reference::transmission_integral(optics, power, *sky);
          EXPECT_LE(std::abs(own.value - right.value), own.error + right.error) << n << " " << k << " " << power;
          EXPECT_LE(own.error + right.error, kMostError * unit + kElevationRounding) << n << " " << k << " " << power;
        }
      }
    }
  }
}

// A medium like air lets all light through: the integral of mu^power is 1 / (power + 1).
TEST(Transmission, MediumLikeAir_IsAPower) {
  for (const double power : {0.01, 0.5, 1.0}) {
    const Estimate own = transmission_integral({1.0, 0.0}, power, kOne);
    EXPECT_NEAR(own.value, 1.0 / (power + 1.0), own.error) << power;
  }
}

}  // namespace
}  // namespace dolp::transmission_test
