#include "model/transmission.hpp"

#include <algorithm>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/smooth_surface.hpp"

namespace dolp {
namespace {

constexpr double kQuadratureError = 1e-12;
// Relative rounding error of the integrand, which takes about 10 operations and a power.
constexpr double kIntegrandRounding = 32.0 * std::numeric_limits<double>::epsilon();
constexpr double kTinyCosine = 1e-100;  // at smaller cosines the integrand counts as 0; its squares would underflow
constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

}  // namespace

Estimate transmission_integral(const FacetOptics& optics, double power, const SkyFunction& sky) {
  constexpr double kVertical = 0.5 * std::numbers::pi;
  // The variable is the elevation, mu = sin(elevation). Boost refuses nodes that round to an end of the interval,
  // unless the integrand has this unused second parameter.
  const auto integrand = [&](double elevation_rad, double) {
    const double mu = std::sin(elevation_rad);
    if (mu < kTinyCosine) return 0.0;
    const SmoothAbsorptance absorbed = smooth_absorptance(optics, mu);
    const double light = std::pow(mu, power) * 0.5 * (absorbed.s + absorbed.p) * std::cos(elevation_rad);
    return light * sky.value((kVertical - elevation_rad) * kDegreesPerRadian);
  };
  std::vector<double> ends = kink_elevations_rad(optics);
  ends.insert(ends.end(), {0.0, kVertical});
  for (const double corner_deg : sky.corners_deg) ends.push_back(kVertical - corner_deg / kDegreesPerRadian);
  std::ranges::sort(ends);
  boost::math::quadrature::tanh_sinh<double> rule;
  Estimate sum;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double low = std::max(ends[i], 0.0);
    const double high = std::min(ends[i + 1], kVertical);
    if (low >= high) continue;
    double error = 0.0;
    double magnitude = 0.0;
    sum.value += rule.integrate(integrand, low, high, kQuadratureError, &error, &magnitude);
    sum.error += error + kIntegrandRounding * magnitude;
  }
  return sum;
}

}  // namespace dolp
