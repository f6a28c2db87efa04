#include "reference/slopes.hpp"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <numbers>

#include "reference/adaptive.hpp"

namespace dolp::reference {

using std::numbers::inv_sqrtpi;
using std::numbers::pi;

namespace {

constexpr double kVerticalSlope = 1e17;  // at larger slopes, gamma equals pi/2 in double precision

// Integral of p(t) weight(t) dt over t in [low, high]. The integrand is smooth in the variable v, t = width sinh(v).
template <class Weight>
double integrate_slopes(const Slopes& slopes, double low, double high, double tolerance, const Weight& weight) {
  const double width = slopes.width();
  const auto integrand = [&](double v) -> Values<1> {
    const double slope = width * std::sinh(v);
    return {slopes.in_plane_density(slope) * weight(slope) * width * std::cosh(v)};
  };
  Breaks breaks(std::asinh(low / width), std::asinh(high / width));
  for (const double v : {1.0, 3.0, 6.0, 12.0, 24.0}) breaks.add(v);
  const Goal goal{.relative = tolerance, .max_panels = 300};
  return integrate<1>(integrand, breaks, goal, [](const Values<1>&) { return Values<1>{1.0}; }).value[0];
}

}  // namespace

double smith_lambda(const Slopes& slopes, const Zenith& zenith) {
  if (zenith.sin <= 0.0) return 0.0;
  const double mu = zenith.cos / zenith.sin;
  const double m = slopes.m();
  if (slopes.is_gaussian()) {
    const double nu = mu / m;
    return 0.5 * inv_sqrtpi * std::exp(-nu * nu) / nu - 0.5 * std::erfc(nu);
  }
  const double q = slopes.q();
  const double share = m * m / (m * m + mu * mu);
  const double gamma_ratio = boost::math::tgamma_delta_ratio(q - 0.5, -0.5);
  const double first = inv_sqrtpi * gamma_ratio * m / mu * std::pow(share, q - 1.5) / (2.0 * q - 3.0);
  return first - 0.5 * boost::math::ibeta(q - 1.0, 0.5, share);
}

IntegralMasking::IntegralMasking(const Slopes& slopes, const Zenith& zenith, double tolerance)
    : slopes_(slopes), zenith_(zenith), tolerance_(tolerance) {
  slope_a_ = zenith.cos >= kVerticalSlope * zenith.sin ? kVerticalSlope : zenith.cos / zenith.sin;
  share_below_ = 0.5 + integrate_slopes(slopes, 0.0, slope_a_, tolerance, [](double) { return 1.0; });
}

double IntegralMasking::operator()(double alpha_rad) const {
  const double limit_rad = 2.0 * zenith_.elevation_rad + alpha_rad;
  const double cos_theta_minus_alpha = std::sin(zenith_.elevation_rad + alpha_rad);
  if (cos_theta_minus_alpha <= 0.0) return share_below_;  // theta = 90 degrees, alpha = 0: the integral is empty
  const auto weight = [&](double slope) {
    const double cos_gamma = 1.0 / std::sqrt(1.0 + slope * slope);
    const double cos_theta_plus_gamma = zenith_.cos * cos_gamma - zenith_.sin * slope * cos_gamma;
    return 1.0 + cos_theta_plus_gamma / cos_theta_minus_alpha;
  };
  if (limit_rad < 0.5 * pi) {
    const double slope_b = std::min(kVerticalSlope, std::tan(limit_rad));
    return share_below_ + integrate_slopes(slopes_, slope_a_, slope_b, tolerance_, weight);
  }
  const double weight_vertical = 1.0 - zenith_.sin / cos_theta_minus_alpha;
  return share_below_ + integrate_slopes(slopes_, slope_a_, kVerticalSlope, tolerance_, weight) +
         weight_vertical * slopes_.in_plane_tail(kVerticalSlope);
}

Attenuation::Attenuation(const Slopes& slopes, Masking masking, const Zenith& a, const Zenith& b, double tolerance)
    : masking_(masking), v_cavity_((a.cos + b.cos) * std::min(a.cos, b.cos)) {
  if (masking == Masking::kSmith) {
    smith_ = std::min(a.cos, b.cos) > 0.0 ? 1.0 / (1.0 + smith_lambda(slopes, a) + smith_lambda(slopes, b)) : 0.0;
  }
  // G is the smaller G_1 of the two directions. It belongs to the direction with the larger zenith.
  if (masking == Masking::kIntegral) integral_.emplace(slopes, a.elevation_rad < b.elevation_rad ? a : b, tolerance);
}

double Attenuation::operator()(double tan2_alpha, double cos2_beta) const {
  switch (masking_) {
    case Masking::kNone:
      return 1.0;
    case Masking::kVCavity:
      // G = 2 cos(alpha) min(cos a, cos b) / cos(beta), with cos(alpha) = (cos a + cos b) / (2 cos(beta)).
      return std::min(1.0, v_cavity_ / cos2_beta);
    case Masking::kIntegral:
      return (*integral_)(std::atan(std::sqrt(tan2_alpha)));
    case Masking::kSmith:
      return smith_;
  }
  return 1.0;
}

}  // namespace dolp::reference
