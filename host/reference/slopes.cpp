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
  // Gamma(q - 1/2) / Gamma(q - 1), which neither overflows nor cancels at large q.
  in_plane_norm_ *= boost::math::tgamma_delta_ratio(q_ - 0.5, -0.5);
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

}  // namespace dolp::reference
