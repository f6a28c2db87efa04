#include "model/slopes.hpp"

#include <algorithm>
#include <boost/math/policies/policy.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <numbers>

namespace dolp {
namespace {

constexpr double kLargestExponent = 500.0;  // limit of the exponent in power_law_reach, so that exp does not overflow

double log1p_square(double x) { return x > 1e8 ? 2.0 * std::log(x) : std::log1p(x * x); }

}  // namespace

double slope_width(const SlopeShape& shape) { return std::sqrt(2.0) * shape.sigma; }

double sigma_of_wind(double wind_m_s) { return std::sqrt(0.5 * (0.003 + 0.00512 * wind_m_s)); }

double wind_of_sigma(double sigma) { return (2.0 * sigma * sigma - 0.003) / 0.00512; }

double steeper_share(Distribution distribution, const SlopeShape& shape, double slope) {
  if (shape.sigma == 0.0) return 0.0;
  const double u = slope / slope_width(shape);
  return distribution == Distribution::kGaussian ? std::exp(-u * u) : std::exp((1.0 - shape.q) * std::log1p(u * u));
}

double log_density(Distribution distribution, const SlopeShape& shape, double slope) {
  const double m = slope_width(shape);
  const double front = 2.0 * log1p_square(slope) - std::log(4.0 * std::numbers::pi) - 2.0 * std::log(m);
  const double u = slope / m;
  if (distribution == Distribution::kGaussian) return front - u * u;
  return front + std::log(shape.q - 1.0) - shape.q * log1p_square(u);
}

double power_law_reach(double share, double exponent) {
  return std::sqrt(std::expm1(std::min(-std::log(share) / exponent, kLargestExponent)));
}

double gamma_ratio(double x) {
  // By default Boost computes in long double. This would take most of the host's time for a slope distribution.
  const boost::math::policies::policy<boost::math::policies::promote_double<false>> in_double;
  if (x < 1.0) return boost::math::tgamma_ratio(x + 0.5, x, in_double);
  return boost::math::tgamma_delta_ratio(x + 0.5, -0.5, in_double);
}

}  // namespace dolp
