#include "reference/slopes.hpp"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <numbers>

namespace dolp::reference {

using std::numbers::inv_sqrtpi;
using std::numbers::pi;

Slopes::Slopes(Distribution distribution, double sigma, double q)
    : distribution_(distribution), m_(std::numbers::sqrt2 * sigma), q_(q), width_(m_), in_plane_norm_(inv_sqrtpi / m_) {
  if (is_gaussian()) return;
  width_ = m_ / std::sqrt(std::max(1.0, q_));
  // Boost computes Gamma(q - 1/2) / Gamma(q - 1) without overflow, and without losing digits at large q.
  in_plane_norm_ *= boost::math::tgamma_delta_ratio(q_ - 0.5, -0.5);
}

Slopes::Slopes(Distribution distribution, const SlopeShape& shape)
    : Slopes(distribution, widest_sigma(shape), shape.q) {
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
  return {distribution_, m / std::numbers::sqrt2, q_};
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

}  // namespace dolp::reference
