#include "methods/direct_brdf.hpp"

#include <algorithm>
#include <boost/math/interpolators/quintic_hermite.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace dolp::bench {

using std::numbers::inv_sqrtpi;
using std::numbers::pi;

/// Tables of three integrals over slopes t from tau to infinity:
///   probability(tau) = int p dt,   first(tau) = int g p dt,   height(tau) = int g p (t - tau) dt
/// p(t) is the density of slopes along one azimuth. The weight g is 1 for `smith`, 1/sqrt(1 + t^2) for `integral`. The
/// tables have nodes at equal steps of asinh(tau/width_). Quintic Hermite polynomials interpolate between the nodes.
class MaskingTails {
 public:
  MaskingTails(const Entry& entry);
  double height(double tau) const { return at(*height_, tau, tail_exponent_); }
  double first(double tau) const { return at(*first_, tau, tail_exponent_ - 1.0); }
  double probability(double tau) const { return at(*probability_, tau, 2.0 - 2.0 * q_); }

 private:
  using Interpolant = boost::math::interpolators::cardinal_quintic_hermite<std::vector<double>>;
  struct Node {
    double tau = 0.0, density = 0.0, height = 0.0, first = 0.0, probability = 0.0;
  };
  double density(double tau) const;
  double weight(double tau) const { return is_smith_ ? 1.0 : 1.0 / std::sqrt(1.0 + tau * tau); }
  Node end() const;
  Node cell(double tau, const Node& beyond) const;
  Interpolant interpolant(const std::vector<Node>& nodes, double Node::*value) const;
  std::pair<double, double> derivatives(const Node& node, double Node::*value) const;
  double at(const Interpolant& function, double tau, double exponent) const;

  bool is_smith_;
  bool is_gaussian_;
  double m_;
  double q_;
  double norm_;           ///< p(0)
  double width_;          ///< the nodes have equal steps of asinh(tau/width_)
  double tail_exponent_;  ///< height(tau) is proportional to tau^tail_exponent_ at large tau
  double end_tau_;
  std::optional<Interpolant> height_, first_, probability_;
};

namespace {

constexpr double kStep = 1.0 / 24.0;      // step of asinh(tau/width_) between nodes; the interpolation error is 1e-12
constexpr double kEndOverWidth = 1e6;     // last tau/max(1, m); integrals at larger tau are powers of tau to 1e-12
constexpr double kVerticalSlope = 1e100;  // limit of sampled_slope(), so that the square of the slope does not overflow
using CellRule = boost::math::quadrature::gauss<double, 4>;

/// Reflectances R_s and R_p, computed without complex numbers. The code uses u and v, where u + iv = N cos(beta'). N is
/// the index n + ik, and beta' the angle of refraction. Source: Born and Wolf, Principles of Optics, 14.2.
struct Reflectances {
  double s;
  double p;
};
Reflectances reflectances(const OpticalConstants& index, double cos_beta) {
  const double sin2 = std::max(0.0, 1.0 - cos_beta * cos_beta);
  const double real = index.n * index.n - index.k * index.k - sin2;
  const double imaginary = 2.0 * index.n * index.k;
  const double modulus = std::sqrt(real * real + imaginary * imaginary);
  const double u2 =
      real > 0.0 ? 0.5 * (modulus + real) : 0.5 * imaginary * imaginary / std::max(modulus - real, 1e-300);
  const double v2 = real > 0.0 ? 0.5 * imaginary * imaginary / (modulus + real) : 0.5 * (modulus - real);
  const double u = std::sqrt(u2);
  const double r_s = ((cos_beta - u) * (cos_beta - u) + v2) / ((cos_beta + u) * (cos_beta + u) + v2);
  // With g = sin(beta) tan(beta), R_p/R_s = ((u - g)^2 + v^2)/((u + g)^2 + v^2). The code multiplies numerator and
  // denominator by cos^2(beta).
  const double low = u * cos_beta - sin2;
  const double high = u * cos_beta + sin2;
  const double v2_cos2 = v2 * cos_beta * cos_beta;
  return {r_s, r_s * (low * low + v2_cos2) / (high * high + v2_cos2)};
}

}  // namespace

MaskingTails::MaskingTails(const Entry& entry)
    : is_smith_(entry.masking == Masking::kSmith),
      is_gaussian_(entry.distribution == Distribution::kGaussian),
      m_(std::numbers::sqrt2 * entry.shape.sigma),
      q_(entry.shape.q),
      norm_(inv_sqrtpi / m_),
      width_(std::min(0.5, is_gaussian_ ? m_ : m_ / std::sqrt(std::max(1.0, q_ / 1.5)))),
      tail_exponent_((is_smith_ ? 3.0 : 2.0) - 2.0 * q_),
      end_tau_(kEndOverWidth * std::max(1.0, m_)) {
  if (!is_gaussian_) norm_ *= boost::math::tgamma_delta_ratio(q_ - 0.5, -0.5);
  const auto count = static_cast<std::size_t>(std::ceil(std::asinh(end_tau_ / width_) / kStep)) + 1;
  end_tau_ = width_ * std::sinh(kStep * static_cast<double>(count - 1));
  std::vector<Node> nodes(count);
  nodes.back() = end();
  for (std::size_t i = count - 1; i-- > 0;) {
    nodes[i] = cell(width_ * std::sinh(kStep * static_cast<double>(i)), nodes[i + 1]);
  }
  height_.emplace(interpolant(nodes, &Node::height));
  first_.emplace(interpolant(nodes, &Node::first));
  probability_.emplace(interpolant(nodes, &Node::probability));
}

double MaskingTails::density(double tau) const {
  const double ratio2 = tau * tau / (m_ * m_);
  return norm_ * (is_gaussian_ ? std::exp(-ratio2) : std::pow(1.0 + ratio2, 0.5 - q_));
}

// The last node of the tables. The integrals beyond this node have closed forms, because there the Cauchy density is
// proportional to tau^(1-2q). The Gaussian density is negligible there.
MaskingTails::Node MaskingTails::end() const {
  const double p = density(end_tau_);
  Node node{.tau = end_tau_, .density = p};
  if (is_gaussian_) return node;
  node.probability = p * end_tau_ / (2.0 * q_ - 2.0);
  node.first = is_smith_ ? node.probability : p / (2.0 * q_ - 1.0);
  node.height = is_smith_ ? node.first * end_tau_ / (2.0 * q_ - 3.0) : node.first * end_tau_ / (2.0 * q_ - 2.0);
  return node;
}

MaskingTails::Node MaskingTails::cell(double tau, const Node& beyond) const {
  Node node{.tau = tau,
            .density = density(tau),
            .height = beyond.height + (beyond.tau - tau) * beyond.first,
            .first = beyond.first,
            .probability = beyond.probability};
  const double centre = 0.5 * (tau + beyond.tau);
  const double half = 0.5 * (beyond.tau - tau);
  const auto add = [&](double x, double w) {
    const double here = centre + half * x;
    const double p = half * w * density(here);
    const double weighted = p * weight(here);
    node.probability += p;
    node.first += weighted;
    node.height += weighted * (here - tau);
  };
  for (std::size_t i = 0; i < CellRule::abscissa().size(); ++i) {
    add(CellRule::abscissa()[i], CellRule::weights()[i]);
    add(-CellRule::abscissa()[i], CellRule::weights()[i]);
  }
  return node;
}

// First and second derivative, with respect to tau, of the integral that `value` selects.
std::pair<double, double> MaskingTails::derivatives(const Node& node, double Node::*value) const {
  const double tau = node.tau;
  const double p = node.density;
  const double p_rise = p * tau * (is_gaussian_ ? -2.0 / (m_ * m_) : (1.0 - 2.0 * q_) / (m_ * m_ + tau * tau));
  const double g = weight(tau);
  const double g_rise = is_smith_ ? 0.0 : -tau * g * g * g;
  if (value == &Node::height) return {-node.first, g * p};
  if (value == &Node::first) return {-g * p, -g_rise * p - g * p_rise};
  return {-p, -p_rise};
}

MaskingTails::Interpolant MaskingTails::interpolant(const std::vector<Node>& nodes, double Node::*value) const {
  std::vector<double> y, slope, curvature;
  for (const Node& node : nodes) {
    const auto [in_tau, twice_in_tau] = derivatives(node, value);
    // The derivatives with respect to X = asinh(tau/width_) need (dtau/dX)^2 = stretch2 and d^2 tau/dX^2 = tau.
    const double stretch2 = width_ * width_ + node.tau * node.tau;
    y.push_back(node.*value);
    slope.push_back(in_tau * std::sqrt(stretch2));
    curvature.push_back(twice_in_tau * stretch2 + in_tau * node.tau);
  }
  return {std::move(y), std::move(slope), std::move(curvature), 0.0, kStep};
}

double MaskingTails::at(const Interpolant& function, double tau, double exponent) const {
  if (tau < end_tau_) return function(std::min(std::asinh(tau / width_), function.domain().second));
  const double value = function(function.domain().second);
  return is_gaussian_ ? 0.0 : value * std::pow(tau / end_tau_, exponent);
}

Entry entry_of(const MomentsRequest& request, std::size_t position) {
  const MomentsPoint point = request[position];
  return {request.distribution, request.masking, point.theta_deg * pi / 180.0, point.shape, point.index.index};
}

DirectSurface::DirectSurface(const Entry& entry, SmithBy smith_by)
    : entry_(entry),
      cos_theta_(std::cos(entry.theta_rad)),
      sin_theta_(std::sin(entry.theta_rad)),
      m_(std::numbers::sqrt2 * entry.shape.sigma) {
  const bool is_smith = entry.masking == Masking::kSmith;
  if (entry.masking == Masking::kIntegral || (is_smith && smith_by == SmithBy::kTable)) {
    tails_ = std::make_unique<MaskingTails>(entry);
  }
  const double mu = cos_theta_ / sin_theta_;
  if (is_smith) fixed_masking_ = smith_lambda(mu);
  if (entry.masking == Masking::kIntegral) fixed_masking_ = tails_->height(mu);
}

DirectSurface::~DirectSurface() = default;

double DirectSurface::slope_density(double tan2_alpha) const {
  const double m2 = m_ * m_;
  if (entry_.distribution == Distribution::kGaussian) return std::exp(-tan2_alpha / m2) / (pi * m2);
  const double q = entry_.shape.q;
  return (q - 1.0) / (pi * m2) * std::pow(1.0 + tan2_alpha / m2, -q);
}

double DirectSurface::sampled_slope(double probability) const {
  if (entry_.distribution == Distribution::kGaussian) return m_ * std::sqrt(-std::log(probability));
  return std::min(kVerticalSlope, m_ * std::sqrt(std::pow(probability, -1.0 / (entry_.shape.q - 1.0)) - 1.0));
}

double DirectSurface::smith_lambda(double mu) const {
  if (tails_) return tails_->height(mu) / mu;
  if (entry_.distribution == Distribution::kGaussian) {
    const double nu = mu / m_;
    return 0.5 * inv_sqrtpi * std::exp(-nu * nu) / nu - 0.5 * std::erfc(nu);
  }
  const double q = entry_.shape.q;
  const double share = m_ * m_ / (m_ * m_ + mu * mu);
  const double norm = inv_sqrtpi * boost::math::tgamma_delta_ratio(q - 0.5, -0.5) / (2.0 * q - 3.0);
  return norm * m_ / mu * std::pow(share, q - 1.5) - 0.5 * boost::math::ibeta(q - 1.0, 0.5, share);
}

RunningBeam DirectSurface::beam(double cos_r, double sin_r) const {
  RunningBeam beam{cos_r, sin_r, 0.0};
  const double mu = cos_r / std::max(sin_r, 1e-300);
  if (entry_.masking == Masking::kSmith) beam.masking = 1.0 / (1.0 + fixed_masking_ + smith_lambda(mu));
  if (entry_.masking == Masking::kIntegral) {
    beam.masking = cos_r < cos_theta_ ? tails_->height(mu) : fixed_masking_;
  }
  return beam;
}

// Masking G of a facet with tilt alpha. With `integral` masking only the beam with the larger zenith angle theta
// matters, because G decreases with theta. Let mu = cot(theta) and kappa = 1/(cos(alpha) (mu + tan(alpha))). Another
// facet of slope t > mu hides the share kappa g(t) (t - mu) of this facet, where g is the weight of MaskingTails. The
// mean over t is 1 - G = kappa height(mu). But if 2 theta - alpha > pi/2, slopes t above tau_b = tan(alpha - 2 theta)
// hide the whole facet: their share is 1. Then
//   1 - G = kappa (height(mu) - height(tau_b) - (tau_b - mu) first(tau_b)) + probability(tau_b)
double DirectSurface::attenuation(const RunningBeam& beam, double cos_alpha, double tan_alpha, double cos_beta) const {
  if (entry_.masking == Masking::kNone) return 1.0;
  if (entry_.masking == Masking::kSmith) return beam.masking;
  if (entry_.masking == Masking::kVCavity) {
    return std::min(1.0, 2.0 * cos_alpha * std::min(cos_theta_, beam.cos) / cos_beta);
  }
  const bool is_running_lower = beam.cos < cos_theta_;
  const double c = is_running_lower ? beam.cos : cos_theta_;
  const double s = is_running_lower ? beam.sin : sin_theta_;
  const double kappa = s / (cos_alpha * (c + s * tan_alpha));
  const double cos_2theta = c * c - s * s;
  const double sin_2theta = 2.0 * s * c;
  const double denominator = cos_2theta + tan_alpha * sin_2theta;
  if (denominator >= 0.0) return 1.0 - kappa * beam.masking;
  const double tau = (tan_alpha * cos_2theta - sin_2theta) / denominator;
  const double beyond = tails_->height(tau) + (tau - c / s) * tails_->first(tau);
  return 1.0 - kappa * (beam.masking - beyond) - tails_->probability(tau);
}

Reflected DirectSurface::reflected(const RunningBeam& beam, double cos_alpha, double tan_alpha, double cos_beta) const {
  const double g = attenuation(beam, cos_alpha, tan_alpha, cos_beta);
  const Reflectances r = reflectances(entry_.index, cos_beta);
  const double sin_sin = sin_theta_ * std::sqrt(std::max(0.0, 1.0 - cos_beta * cos_beta));
  const double cos_eta = sin_sin > 0.0 ? (cos_alpha - cos_theta_ * cos_beta) / sin_sin : std::numbers::sqrt2 / 2.0;
  return {0.5 * g * (r.s + r.p), 0.5 * g * (2.0 * cos_eta * cos_eta - 1.0) * (r.s - r.p)};
}

Reflected beam_integrand(const DirectSurface& surface, const RunningBeam& beam, double cos_azimuth) {
  const double c = surface.cos_theta();
  const double cos_2beta = c * beam.cos + surface.sin_theta() * beam.sin * cos_azimuth;
  const double cos_beta = std::sqrt(0.5 * (1.0 + cos_2beta));
  const double cos_alpha = std::min(1.0, (c + beam.cos) / (2.0 * cos_beta));
  const double cos2_alpha = cos_alpha * cos_alpha;
  const double tan2_alpha = 1.0 / cos2_alpha - 1.0;
  const double density = 0.5 * surface.slope_density(tan2_alpha) / (cos2_alpha * cos2_alpha) * beam.sin;
  const Reflected facet = surface.reflected(beam, cos_alpha, std::sqrt(tan2_alpha), cos_beta);
  return {density * facet.i, density * facet.q};
}

Reflected half_vector_integrand(const DirectSurface& surface, double tan_alpha, double cos_phi) {
  const double cos_alpha = 1.0 / std::sqrt(1.0 + tan_alpha * tan_alpha);
  const double projected = surface.cos_theta() + surface.sin_theta() * tan_alpha * cos_phi;  // cos(beta)/cos(alpha)
  const double cos_r = 2.0 * cos_alpha * cos_alpha * projected - surface.cos_theta();
  if (cos_r <= 0.0) return {};
  const double cos_beta = std::min(1.0, projected * cos_alpha);
  const RunningBeam beam = surface.beam(cos_r, std::sqrt(std::max(0.0, 1.0 - cos_r * cos_r)));
  const Reflected facet = surface.reflected(beam, cos_alpha, tan_alpha, cos_beta);
  return {projected * facet.i, projected * facet.q};
}

}  // namespace dolp::bench
