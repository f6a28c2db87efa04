#include "run/closed_forms.hpp"

#include <algorithm>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "model/smooth_surface.hpp"
#include "model/transmission.hpp"

namespace dolp {
namespace {

// Facets with slopes up to this value count as a mirror. The error estimate contains the share of steeper facets.
constexpr double kMirrorSlope = 1e-6;

double steep_share(const Surface& surface, const SlopeShape& shape) {
  const double share = steeper_share(surface.distribution, shape, kMirrorSlope);
  const bool has_tail = shape.sigma > 0.0 && surface.distribution == Distribution::kCauchy;
  return has_tail ? share + kMirrorSlope : share;
}

constexpr double kRelativeError = 1e-12;
constexpr double kAgreement = 1e-13;  // relative difference of two successive approximations that ends the quadrature
constexpr double kReflectanceRounding = 8.0 * std::numeric_limits<double>::epsilon();  // error bound of 1 - absorptance

// Below this cosine the integrand counts as 0: there it is negligible, and the square of the cosine may underflow.
constexpr double kSmallestCosine = 1e-100;

constexpr double kHorizon_deg = 90.0;
// A facet with a slope up to kMirrorSlope turns the reflected ray by at most this angle.
constexpr double kMirrorSpread_deg = 2.0 * kMirrorSlope * 180.0 / std::numbers::pi;

/// Appends a column for each function of the sky: r_i and r_q times the function at `zenith_deg`. The error of a column
/// includes the change of the function up to `spread_deg` away.
void add_sky(Moments& moments, const SkyBasis& sky, double zenith_deg, double spread_deg) {
  const Eigen::RowVectorXd at = sky.at(zenith_deg);
  const Eigen::RowVectorXd above = sky.at(std::max(zenith_deg - spread_deg, 0.0));
  const Eigen::RowVectorXd below = sky.at(std::min(zenith_deg + spread_deg, kHorizon_deg));
  for (Eigen::Index k = 0; k < at.size(); ++k) {
    const double change = std::max(std::abs(above[k] - at[k]), std::abs(below[k] - at[k]));
    moments.columns.push_back({at[k] * moments.r_i, at[k] * moments.r_q,
                               2.0 * std::max(moments.r_i_error, moments.r_q_error) + change * moments.r_i});
  }
}

}  // namespace

Moments closed_form(const Surface& surface, const Direction& direction, const SlopeShape& shape,
                    const FacetOptics& index, const SkyBasis* sky) {
  if (direction.treatment == Treatment::kDivergentLimit && is_elliptic(shape)) {
    Moments unknown;  // the limit of slopes that differ along and across is not implemented
    unknown.r_i = unknown.r_q = unknown.deficit = std::numeric_limits<double>::quiet_NaN();
    return unknown;
  }
  if (direction.treatment == Treatment::kDivergentLimit) {
    Moments moments = grazing_limit_moments(index, shape.q);
    if (sky) add_sky(moments, *sky, kHorizon_deg, 0.0);  // at 90 degrees vertical facets reflect light from the horizon
    return moments;
  }
  const double steep = steep_share(surface, shape) * direction.cos_theta;
  Moments moments = mirror_moments(index, direction.cos_theta);
  for (const auto& [value, error] : kMomentMembers) moments.*error += steep;
  if (sky) add_sky(moments, *sky, direction.theta_deg, shape.sigma > 0.0 ? kMirrorSpread_deg : 0.0);
  return moments;
}

Moments grazing_limit_moments(const FacetOptics& index, double q) {
  constexpr double kEnd = 0.5 * std::numbers::pi;
  boost::math::quadrature::tanh_sinh<double> integrator;
  std::vector<double> ends = kink_elevations_rad(index);
  ends.insert(ends.end(), {0.0, kEnd});
  std::ranges::sort(ends);
  // The integrand is not smooth near x = cos(phi) = 0. There sin(psi), with psi = pi/2 - phi, has a smaller rounding
  // error than cos(phi). So the integral is over psi.
  const auto integral = [&](auto&& cosine_factor) {
    // Boost refuses nodes that round to an end of the interval, unless the integrand has this unused second parameter.
    const auto integrand = [&](double psi, double) {
      const double x = std::sin(psi);
      return x > kSmallestCosine ? std::pow(x, 4.0 - 2.0 * q) * cosine_factor(x) : 0.0;
    };
    Estimate sum;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      double error = 0.0;
      if (ends[i] < ends[i + 1]) sum.value += integrator.integrate(integrand, ends[i], ends[i + 1], kAgreement, &error);
      sum.error += error;
    }
    return sum;
  };
  const auto half_sum = [&](double x) {
    const SmoothAbsorptance absorbed = smooth_absorptance(index, x);
    return 1.0 - 0.5 * (absorbed.s + absorbed.p);
  };
  const auto half_difference = [&](double x) {
    const SmoothAbsorptance absorbed = smooth_absorptance(index, x);
    return 0.5 * (absorbed.s - absorbed.p);
  };
  const Estimate albedo = integral([](double) { return 1.0; });
  const Estimate r_i = integral(half_sum);
  const Estimate r_q = integral(half_difference);
  const double rounding = kRelativeError * r_i.value + kReflectanceRounding * albedo.value;
  Moments moments;
  moments.albedo = albedo.value;
  moments.r_i = r_i.value;
  moments.r_q = r_q.value;
  moments.deficit = -moments.r_i;
  moments.albedo_error = albedo.error + kRelativeError * moments.albedo;
  moments.r_i_error = moments.deficit_error = r_i.error + rounding;
  moments.r_q_error = r_q.error + rounding;
  return moments;
}

}  // namespace dolp
