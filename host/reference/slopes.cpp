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

Slopes::Slopes(Distribution distribution, const SlopeShape& shape)
    : distribution_(distribution),
      m_(std::numbers::sqrt2 * widest_sigma(shape)),
      q_(shape.q),
      width_(m_),
      in_plane_norm_(inv_sqrtpi / m_) {
  if (!is_gaussian()) {
    width_ = m_ / std::sqrt(std::max(1.0, q_));
    // Boost computes Gamma(q - 1/2) / Gamma(q - 1) without overflow, and without losing digits at large q.
    in_plane_norm_ *= boost::math::tgamma_delta_ratio(q_ - 0.5, -0.5);
  }
  if (!is_elliptic(shape)) return;
  const double narrow = std::numbers::sqrt2 * narrowest_sigma(shape);
  elongation_ = m_ / narrow;
  excess_ = (1.0 / narrow - 1.0 / m_) * (1.0 / narrow + 1.0 / m_);
  const double narrow_deg = shape.azimuth_deg + (shape.sigma < shape.sigma_cross ? 0.0 : 90.0);
  narrow_cos_ = std::cos(narrow_deg * pi / 180.0);
  narrow_sin_ = std::sin(narrow_deg * pi / 180.0);
  ridge_rad_ = std::atan2(std::abs(narrow_cos_), std::abs(narrow_sin_));
}

double Slopes::weight(double tan2_alpha, double cos_phi, double sin_phi) const {
  if (elongation_ == 1.0) return 1.0;
  const double narrow = cos_phi * narrow_cos_ + sin_phi * narrow_sin_;
  const double off = narrow * narrow * tan2_alpha * excess_;
  if (is_gaussian()) return elongation_ * std::exp(-off);
  return elongation_ * std::exp(-q_ * std::log1p(off / (1.0 + tan2_alpha / (m_ * m_))));
}

Slopes Slopes::in_view_plane() const {
  if (elongation_ == 1.0) return *this;
  const double m = m_ * std::hypot(narrow_sin_, narrow_cos_ / elongation_);
  return {distribution_, {m / std::numbers::sqrt2, q_}};
}

MirrorWeights Slopes::mirror_weights(double tan2_alpha, double cos_phi, double sin_phi) const {
  const double own = weight(tan2_alpha, cos_phi, sin_phi);
  const double mirrored = weight(tan2_alpha, cos_phi, -sin_phi);
  return {0.5 * (own + mirrored), 0.5 * (own - mirrored)};
}

double Slopes::weight_above(double t) const {
  if (elongation_ == 1.0) return 1.0;
  constexpr int kAzimuths = 256;  // the mean over a period converges exponentially
  // At an azimuth with off = (1 / m^2 of this azimuth) - (1 / m^2), the integral of P t dt from t on is elementary.
  double sum = 0.0;
  for (int i = 0; i < kAzimuths; ++i) {
    const double narrow = std::cos((i + 0.5) * 0.5 * pi / kAzimuths);
    const double off = narrow * narrow * excess_;
    const double decay =
        is_gaussian() ? -t * t * off : (1.0 - q_) * std::log1p(off / (1.0 / (t * t) + 1.0 / (m_ * m_)));
    sum += elongation_ * std::exp(decay) / (1.0 + off * m_ * m_);
  }
  return sum / kAzimuths;
}

double Slopes::facet_density(double tan2_alpha) const {
  const double m2 = m_ * m_;
  const double inverse_cos4 = (1.0 + tan2_alpha) * (1.0 + tan2_alpha);
  if (is_gaussian()) return std::exp(-tan2_alpha / m2) * inverse_cos4 / (pi * m2);
  return (q_ - 1.0) * std::exp(-q_ * std::log1p(tan2_alpha / m2)) * inverse_cos4 / (pi * m2);
}

double Slopes::in_plane_density(double slope) const {
  const double ratio = slope / m_;
  if (is_gaussian()) return in_plane_norm_ * std::exp(-ratio * ratio);
  return in_plane_norm_ * std::exp((0.5 - q_) * std::log1p(ratio * ratio));
}

double Slopes::in_plane_tail(double slope) const {
  if (is_gaussian()) return 0.0;
  return in_plane_norm_ * m_ * std::pow(slope / m_, 2.0 - 2.0 * q_) / (2.0 * q_ - 2.0);
}

double Slopes::density_at(double v) const {
  const double slope = at(v);
  const double inverse_cos2 = 1.0 + slope * slope;
  const double plane = facet_density(slope * slope) / (inverse_cos2 * inverse_cos2);
  return 2.0 * pi * plane * slope * width_ * std::cosh(v);
}

double Slopes::share_above(double t) const {
  const double u = t / m_;
  return is_gaussian() ? std::exp(-u * u) : std::exp((1.0 - q_) * std::log1p(u * u));
}

double Slopes::length_above(double t) const {
  if (is_gaussian()) return 0.0;
  return 2.0 * (q_ - 1.0) / (2.0 * q_ - 3.0) * t * share_above(t);
}

double Slopes::quantile(double share) const {
  const double log_share = -std::log(share);
  const double u2 = is_gaussian() ? log_share : std::expm1(std::min(500.0, log_share / (q_ - 1.0)));
  return m_ * std::sqrt(u2);
}

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
