#include "beams/in_plane_masking.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "base/numbers.hpp"

namespace dolp {
namespace {

using PanelRule = boost::math::quadrature::gauss<double, 16>;  // exact to rounding on a panel of length 1

constexpr double kCutExponent = 45.0;     // the integrals end where p is exp(-45) of its maximum
constexpr double kSmallestSigma = 1e-15;  // otherwise (slope / m)^2 could overflow
constexpr double kPowerLawSlope = 1e7;    // in units of max(m, 1); from there the power law has 14 digits
constexpr double kSmallestSine = 1e-18;
constexpr double kSmallestCotangent = 1e-30;
constexpr double kLargestLimit = 1e20;  // hardly any slope is larger

}  // namespace

InPlaneMasking::InPlaneMasking(Distribution distribution, Masking masking, const SlopeShape& shape)
    : distribution_(distribution),
      masking_(masking),
      q_minus_1_(shape.q - 1.0),
      m_(slope_width({std::max(shape.sigma, kSmallestSigma)})) {
  const bool is_cauchy = distribution == Distribution::kCauchy;
  norm_ = (is_cauchy ? gamma_ratio(q_minus_1_) : 1.0) / (kRootPi * m_);
  scale_ = std::min(is_cauchy ? m_ / std::sqrt(shape.q) : m_, 1.0);
  const double cut = m_ * std::sqrt(is_cauchy ? std::expm1(kCutExponent / (shape.q - 0.5)) : kCutExponent);
  end_ = std::min(cut, kPowerLawSlope * std::max(m_, 1.0));
  const double extent = std::asinh(end_ / scale_);
  const auto panels = static_cast<std::size_t>(extent) + 1;
  length_ = extent / static_cast<double>(panels);
  for (std::size_t i = 0; i < panels; ++i) {
    const auto panel = static_cast<double>(i);
    starts_.push_back(scale_ * std::sinh(panel * length_));
    panels_.push_back(within_panel(starts_.back(), panel, panel + 1.0));
  }
}

double InPlaneMasking::attenuation(const BeamGeometry& beam) {
  if (masking_ == Masking::kIntegral) return 1.0 - shadowed(beam);
  return 1.0 / (1.0 + lambda(beam.i, lambda_i_) + lambda(beam.r, lambda_r_));
}

double InPlaneMasking::smith_toward(const CosSin& zenith) { return 1.0 / (1.0 + lambda(zenith, lambda_i_)); }

double InPlaneMasking::density(double slope) const {
  const double u = slope / m_;
  if (distribution_ == Distribution::kGaussian) return norm_ * std::exp(-u * u);
  return norm_ * std::exp(-(q_minus_1_ + 0.5) * std::log1p(u * u));
}

double InPlaneMasking::weight(double slope) const {
  return masking_ == Masking::kSmith ? 1.0 : 1.0 / std::sqrt(1.0 + slope * slope);
}

/// A position on the axis of the panels. Panel i reaches from i to i + 1.
double InPlaneMasking::panel_position(double slope) const { return std::asinh(slope / scale_) / length_; }

/// Integrals over a part of a panel. `from`: the slope at `first_panel`.
InPlaneMasking::Integrals InPlaneMasking::within_panel(double from, double first_panel, double last_panel) const {
  const double middle = 0.5 * length_ * (first_panel + last_panel);
  const double half = 0.5 * length_ * (last_panel - first_panel);
  Integrals sum;
  const auto add = [&](double x, double node_weight) {
    const double e = std::exp(x);
    const double slope = 0.5 * scale_ * (e - 1.0 / e);
    const double share = node_weight * density(slope) * 0.5 * scale_ * (e + 1.0 / e);
    sum.share += share;
    sum.weighted += share * weight(slope);
    sum.height += share * weight(slope) * std::max(slope - from, 0.0);
  };
  for (std::size_t i = 0; i < PanelRule::abscissa().size(); ++i) {
    add(middle - half * PanelRule::abscissa()[i], half * PanelRule::weights()[i]);
    add(middle + half * PanelRule::abscissa()[i], half * PanelRule::weights()[i]);
  }
  return sum;
}

InPlaneMasking::Integrals InPlaneMasking::power_law_above(double slope) const {
  if (distribution_ == Distribution::kGaussian) return {};
  const double a = 2.0 * q_minus_1_;  // p falls like tau^(-1 - a)
  const double share = density(slope) * slope / a;
  if (masking_ == Masking::kSmith) return {share, share, share * slope / (a - 1.0)};
  const double weighted = density(slope) / (a + 1.0);  // g is 1 / tau
  return {share, weighted, weighted * slope / a};
}

/// Integrals between two slopes, as sums of positive terms.
InPlaneMasking::Integrals InPlaneMasking::between(double from, double to) const {
  Integrals sum;
  const auto add = [&](const Integrals& part, double start) {
    sum.share += part.share;
    sum.weighted += part.weighted;
    sum.height += part.height + (start - from) * part.weighted;
  };
  if (from < end_) {
    const double first = panel_position(from);
    const double last = to < end_ ? panel_position(to) : static_cast<double>(panels_.size());
    auto next = static_cast<std::size_t>(first) + 1;
    add(within_panel(from, first, std::min(static_cast<double>(next), last)), from);
    for (; static_cast<double>(next) + 1.0 <= last; ++next) add(panels_[next], starts_[next]);
    const auto start = static_cast<double>(next);
    if (start < last) add(within_panel(starts_[next], start, last), starts_[next]);
  }
  if (to > end_) {
    const double start = std::max(from, end_);
    Integrals part = power_law_above(start);
    if (std::isfinite(to)) {
      const Integrals beyond = power_law_above(to);
      part.share -= beyond.share;
      part.weighted -= beyond.weighted;
      part.height -= beyond.height + (to - start) * beyond.weighted;
    }
    add(part, start);
  }
  return sum;
}

/// At 90 degrees Lambda is so large that G is 0.
double InPlaneMasking::lambda(const CosSin& zenith, Lambda& last) const {
  const double cotangent = std::max(zenith.cos / std::max(zenith.sin, kSmallestSine), kSmallestCotangent);
  if (cotangent != last.cotangent) last = {cotangent, between(cotangent, kInfinity).height / cotangent};
  return last.value;
}

/// 1 - G_1 of `integral`.
double InPlaneMasking::shadowed(const BeamGeometry& beam) const {
  const CosSin lower = lower_direction(beam);
  const double c = lower.cos;
  const double s = std::max(lower.sin, kSmallestSine);
  const double t = beam.slope;
  const double mu = c / s;
  const double kappa = s * std::sqrt(1.0 + t * t) / (c + s * t);
  const double difference = (s - c) * (s + c);
  const double twice_product = 2.0 * s * c;
  const double d = difference - twice_product * t;
  if (d <= 0.0) return kappa * between(mu, kInfinity).height;
  const double limit = std::min((difference * t + twice_product) / d, kLargestLimit);
  return kappa * between(mu, limit).height + between(limit, kInfinity).share;
}

}  // namespace dolp
