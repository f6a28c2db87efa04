#include "plan/rule.hpp"

#include <algorithm>
#include <array>
#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <numbers>

#include "model/gamma_ratio.hpp"

namespace dolp {
namespace {

constexpr std::array<RuleModel, 4> kModels = {{
    // none
    {.margin_digits = 2.05,
     .t_nodes = 1.67,
     .t_strip = 1.12,
     .t_oblique = 0.0203,
     .t_root_nodes = 0.561,
     .t_curvature = 0.149,
     .phi_half_nodes = 0.349,
     .phi_centre_nodes = 0.439,
     .strip = {2.11, 1.0, 1.0},
     .phi_grazing = 0.336,
     .phi_curvature = 0.0861,
     .phi_circle_nodes = 1.26,
     .phi_circle_growth = 0.673,
     .phi_pole_growth = 0.452,
     .circle_pole = 1.17,
     .phi_cluster_growth = 1.35},
    // v-cavity
    {.margin_digits = 2.7,
     .t_nodes = 0.919,
     .t_strip = 1.18,
     .t_oblique = -0.202,
     .t_root_nodes = 0.581,
     .t_curvature = 0.165,
     .phi_half_nodes = 0.811,
     .phi_centre_nodes = 0.101,
     .strip = {5.34, 3.96, 2.97},
     .phi_grazing = 0.215,
     .phi_curvature = 0.0786,
     .phi_circle_nodes = 1.03,
     .phi_circle_growth = 0.883,
     .phi_pole_growth = 0.465,
     .circle_pole = 1.28},
    // integral
    {.margin_digits = 2.1,
     .t_nodes = 0.895,
     .t_strip = 1.08,
     .t_oblique = 0.0295,
     .t_root_nodes = 0.817,
     .t_curvature = 0.167,
     .phi_half_nodes = 0.604,
     .phi_centre_nodes = 0.267,
     .strip = {3.8, 4.41, 2.91},
     .phi_grazing = 0.59,
     .phi_curvature = 0.188,
     .phi_circle_nodes = 0.75,
     .phi_circle_growth = 0.981,
     .phi_pole_growth = 0.283,
     .circle_pole = 0.815,
     .phi_cluster_growth = 1.52,
     .cluster_curvature = 0.265,
     .cluster_pole = 0.735,
     .t_line = 1,
     .phi_line = 0.944,
     .line_threshold = 5.47e+05},
    // smith
    {.margin_digits = 1.7,
     .t_nodes = 1.13,
     .t_strip = 0.694,
     .t_oblique = -0.266,
     .t_root_nodes = 0.639,
     .t_curvature = 0.221,
     .phi_half_nodes = 0.526,
     .phi_centre_nodes = -0.308,
     .strip = {1.41, 1.0, 1.0},
     .phi_grazing = -0.234,
     .phi_curvature = 0.235,
     .phi_circle_nodes = 0.867,
     .phi_circle_growth = 1.09,
     .phi_pole_growth = 0.213,
     .circle_pole = 0.0564,
     .phi_cluster_growth = 3.57,
     .cluster_curvature = -0.00769,
     .cluster_pole = 0.446,
     .t_line = 0.7,
     .phi_line = 0.6,
     .cusp_digits = 4.04,
     .line_threshold = 4.5e+06,
     .tight_growth = 0.08},
}};

constexpr double kCalibratedDigits = 4.0;  // where the curvatures vanish

// The cluster of `integral` below this q, at this many digits and more.
constexpr double kClusterBelowQ = 1.6;
constexpr double kClusterDigits = 4.5;
constexpr double kTightClusterBelowQ = 2.4;
constexpr double kTightDigits = 8.0;  // from which on the singularities count that are too weak to be felt before

// The line b = pi/2 of `integral` matters for tails that reach slope 1.
constexpr double kSmoothLineQ = 4.0;
constexpr double kSmoothLineSigma = 0.6;  // of the gaussian
constexpr double kTightLineSigma = 0.3;

// Smith's cusp of the gaussian is smooth, but all its derivatives vanish there.
constexpr double kGaussianCuspSigma = 0.8;
constexpr double kGaussianCuspDigits = 0.0;

// Nodes of a piece that smith's cusp is in, and the digits from which on their number bounds what they reach.
constexpr double kUnsplitNodes = 40.0;
constexpr double kUnsplitDigits = 10.0;

// Digits that smith's cusp loses for each unit of q beyond 2: the higher the derivative that it is in, the less the
// rules feel it.
constexpr double kCuspPerQ = 1.5;
constexpr double kSharpCuspQ = 2.0;

// Digits by which RuleModel::cusp_digits falls for each digit from here on.
constexpr double kCuspDigits = 7.0;
constexpr double kCuspFall = 1.0;

// Largest orders of the rules: what few digits can use, and what each digit beyond asks for.
constexpr double kPlainOrder = 64.0;
constexpr double kOrderPerDigit = 8.0;

constexpr double kNoCusp = -1000.0;

double cusp_offset(Distribution distribution, const SlopeShape& shape, double digits) {
  const double smooth = distribution == Distribution::kCauchy ? kCuspPerQ * std::max(0.0, shape.q - kSharpCuspQ) : 0.0;
  const double small = rule_model(Masking::kSmith).cusp_digits - kCuspFall * std::max(0.0, digits - kCuspDigits);
  return smooth + std::max(0.0, small);
}

// log10 of the size of smith's cusp, L = C (m tan(theta_r))^(2q-2) and more beside theta_r = 0; kNoCusp where none is
// felt.
double cusp_size(Distribution distribution, const SlopeShape& shape, double digits) {
  if (distribution == Distribution::kGaussian) {
    const bool is_felt = shape.sigma > kGaussianCuspSigma && digits > kTightDigits;
    return is_felt ? kGaussianCuspDigits + cusp_offset(distribution, shape, digits) : kNoCusp;
  }
  const double from_integer = std::abs(shape.q - std::round(shape.q));
  if (from_integer == 0.0) return kNoCusp;
  const double width = std::min(1.0, std::numbers::sqrt2 * shape.sigma);
  const double coefficient = gamma_ratio(shape.q - 1.0) / (boost::math::constants::root_pi<double>() *
                                                           (2.0 * shape.q - 3.0) * (2.0 * shape.q - 2.0));
  return (2.0 * shape.q - 2.0) * std::log10(width) + std::log10(coefficient * std::min(1.0, 4.0 * from_integer));
}

double curved(double curvature, double digits) { return std::max(0.5, 1.0 + curvature * (digits - kCalibratedDigits)); }

}  // namespace

const RuleModel& rule_model(Masking masking) { return kModels[static_cast<std::size_t>(masking)]; }

double rule_digits(Masking masking, double tolerance) {
  return rule_model(masking).margin_digits - std::log10(tolerance);
}

kernel::RuleNode rule_node(Masking masking, double digits) {
  const RuleModel& model = rule_model(masking);
  kernel::RuleNode node{};
  node.digits = digits;
  node.t_nodes = model.t_nodes;
  node.t_growth = curved(model.t_curvature, digits);
  node.t_curvature = model.t_curvature;
  node.t_strip = model.t_strip;
  node.t_root_nodes = model.t_root_nodes;
  node.phi_half_nodes = model.phi_half_nodes;
  node.phi_centre_nodes = model.phi_centre_nodes;
  node.phi_circle_nodes = model.phi_circle_nodes;
  node.phi_growth = curved(model.phi_curvature, digits);
  node.phi_curvature = model.phi_curvature;
  node.phi_circle_growth = node.phi_growth * model.phi_circle_growth;
  node.phi_pole_growth = node.phi_growth * model.phi_pole_growth;
  node.circle_pole = model.circle_pole;
  const double tight = 1.0 + model.tight_growth * std::max(0.0, digits - kTightDigits);
  node.t_growth *= tight;
  node.phi_cluster_digits = curved(model.cluster_curvature, digits) * tight;
  node.cluster_pole_growth = model.cluster_pole;
  node.phi_cluster_growth = model.phi_cluster_growth;
  node.largest_order = std::min<double>(DOLP_MAX_ORDER, std::max(kPlainOrder, std::ceil(kOrderPerDigit * digits)));
  std::copy(std::begin(model.strip), std::end(model.strip), std::begin(node.strip));
  node.cluster_below_q = digits > kTightDigits ? kTightClusterBelowQ : digits > kClusterDigits ? kClusterBelowQ : 0.0;
  return node;
}

bool needs_line(Distribution distribution, Masking masking, const SlopeShape& shape, double digits) {
  const double threshold = rule_model(masking).line_threshold * std::pow(10.0, -digits);
  if (masking == Masking::kSmith) {
    // A rule that does not split at |x|^(2q-2) gains with its nodes to the power 2q, and no more however many digits.
    const double gain = std::pow(kUnsplitNodes, 2.0 * shape.q) * std::pow(10.0, -digits);
    return std::pow(10.0, cusp_size(distribution, shape, digits)) >
           (digits > kUnsplitDigits ? std::min(threshold, gain) : threshold);
  }
  if (masking != Masking::kIntegral) return false;
  if (distribution == Distribution::kGaussian) {
    return shape.sigma > (digits > kTightDigits ? kTightLineSigma : kSmoothLineSigma);
  }
  const double tail = std::pow(1.0 + 0.5 / (shape.sigma * shape.sigma), 1.0 - shape.q);
  return shape.q < kSmoothLineQ && tail > threshold * std::exp(1.5 * (shape.q - 1.0));
}

double cusp_digits(Distribution distribution, Masking masking, const SlopeShape& shape, double digits) {
  if (masking != Masking::kSmith) return kNoCusp;
  const double size = cusp_size(distribution, shape, digits);
  return size > kNoCusp ? size - cusp_offset(distribution, shape, digits) : kNoCusp;
}

}  // namespace dolp
