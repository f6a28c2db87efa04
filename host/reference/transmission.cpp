// The integral of polarised diffuse reflection, over the zenith theta of the incident light. The variable of
// model/transmission.cpp is the elevation, and its quadrature is another one.
#include <cmath>
#include <limits>
#include <numbers>

#include "reference/adaptive.hpp"
#include "reference/fresnel.hpp"
#include "reference/moments.hpp"

namespace dolp::reference {

using std::numbers::pi;

namespace {

constexpr double kTransmissionTolerance = 1e-12;
constexpr double kTransmissionRounding = 64.0 * std::numeric_limits<double>::epsilon();

}  // namespace

Estimate transmission_integral(const FacetOptics& optics, double power, const SkyFunction& sky) {
  const auto integrand = [&](double theta_rad) -> Values<2> {
    const double mu = std::cos(theta_rad);
    const FresnelCoefficients r = fresnel(optics, mu);
    const double light = std::pow(mu, power) * 0.5 * (r.absorbed_s + r.absorbed_p) * std::sin(theta_rad);
    const double value = light * sky.value(theta_rad * 180.0 / pi);
    return {value, std::abs(value)};
  };
  Breaks breaks(0.0, 0.5 * pi);
  const double n2 = optics.index.n * optics.index.n - optics.index.k * optics.index.k;
  if (n2 > 0.0 && n2 < 1.0) breaks.add(std::asin(std::sqrt(n2)));  // total reflection begins
  for (const double corner_deg : sky.corners_deg) breaks.add(corner_deg * pi / 180.0);
  const auto scale = [](const Values<2>& total) { return Values<2>{total[1], total[1]}; };
  const Integral<2> integral = integrate<2>(integrand, breaks, {.relative = kTransmissionTolerance}, scale);
  return {integral.value[0], integral.error[0] + kTransmissionRounding * integral.value[1]};
}

}  // namespace dolp::reference
