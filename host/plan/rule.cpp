#include "plan/rule.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace dolp {
namespace {

constexpr std::array<RuleModel, 4> kModels = {{
    // none
    {.margin_digits = 2.15,
     .t_nodes = 2.07,
     .t_strip = 0.913,
     .t_oblique = -0.028,
     .t_root_nodes = 0.205,
     .t_curvature = 0.0847,
     .phi_half_nodes = 0.145,
     .phi_centre_nodes = 0.375,
     .strip = {2.27, 1.0, 1.0},
     .phi_grazing = 0.815,
     .phi_curvature = 0.061,
     .phi_circle_nodes = 1.03,
     .phi_circle_growth = 0.631,
     .phi_cluster_growth = 0.945,
     .doubt_factor = 2.5},
    // v-cavity
    {.margin_digits = 2.46,
     .t_nodes = 0.981,
     .t_strip = 0.907,
     .t_oblique = -0.319,
     .t_root_nodes = 0.644,
     .t_curvature = 0.186,
     .phi_half_nodes = 0.607,
     .phi_centre_nodes = 0.246,
     .strip = {2.09, 3.12, 2.7},
     .phi_grazing = 0.125,
     .phi_curvature = 0.0485,
     .phi_circle_nodes = 1.3,
     .phi_circle_growth = 0.836,
     .doubt_factor = 2.5},
    // integral
    {.margin_digits = 2.18,
     .t_nodes = 0.919,
     .t_strip = 0.924,
     .t_oblique = -0.0129,
     .t_root_nodes = 0.438,
     .t_curvature = 0.193,
     .phi_half_nodes = 0.54,
     .phi_centre_nodes = 0.391,
     .strip = {4.09, 3.03, 2.06},
     .phi_grazing = 0.267,
     .phi_curvature = 0.154,
     .phi_circle_nodes = 0.691,
     .phi_circle_growth = 1.34,
     .phi_cluster_growth = 3.8,
     .line_threshold = 2.7e+04,
     .doubt_factor = 2.5},
    // smith
    {.margin_digits = 1.86,
     .t_nodes = 0.753,
     .t_strip = 0.628,
     .t_oblique = -0.212,
     .t_root_nodes = 0.54,
     .t_curvature = 0.226,
     .phi_half_nodes = 0.631,
     .phi_centre_nodes = 0.0513,
     .strip = {1.18, 1.0, 1.0},
     .phi_grazing = -0.339,
     .phi_curvature = 0.201,
     .phi_circle_nodes = 0.815,
     .phi_circle_growth = 1.05,
     .phi_cluster_growth = 4.09,
     .cusp_digits = 4.09,
     .line_threshold = 2.97e+04,
     .doubt_factor = 2.5},
}};

constexpr double kCalibratedDigits = 4.0;  // where the curvatures vanish

// The cluster of `integral` below this q, at this many digits and more.
constexpr double kClusterBelowQ = 1.6;
constexpr double kClusterDigits = 4.5;

// The line b = pi/2 of `integral` matters for tails that reach slope 1.
constexpr double kSmoothLineQ = 4.0;
constexpr double kSmoothLineSigma = 0.6;  // of the gaussian

constexpr double kNoCusp = -1000.0;

double curved(double curvature, double digits) {
  return std::max(0.5, 1.0 + curvature * (digits - kCalibratedDigits));
}

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
  node.t_strip = model.t_strip;
  node.t_root_nodes = model.t_root_nodes;
  node.phi_half_nodes = model.phi_half_nodes;
  node.phi_centre_nodes = model.phi_centre_nodes;
  node.phi_circle_nodes = model.phi_circle_nodes;
  node.phi_growth = curved(model.phi_curvature, digits);
  node.phi_circle_growth = node.phi_growth * model.phi_circle_growth;
  node.phi_horizon_growth = node.phi_growth * model.phi_horizon_growth;
  node.circle_pole = model.circle_pole;
  node.phi_cluster_growth = model.phi_cluster_growth;
  std::copy(std::begin(model.strip), std::end(model.strip), std::begin(node.strip));
  node.cluster_below_q = digits > kClusterDigits ? kClusterBelowQ : 0.0;
  return node;
}

bool needs_line(Distribution distribution, Masking masking, const SlopeShape& shape, double digits) {
  const bool cauchy = distribution == Distribution::kCauchy;
  const double threshold = rule_model(masking).line_threshold * std::pow(10.0, -digits);
  if (masking == Masking::kSmith) {
    return cauchy && cusp_digits(distribution, masking, shape) + rule_model(masking).cusp_digits >
                         std::log10(std::max(threshold, 1e-300));
  }
  if (masking != Masking::kIntegral) return false;
  if (!cauchy) return shape.sigma > kSmoothLineSigma;
  const double tail = std::pow(1.0 + 0.5 / (shape.sigma * shape.sigma), 1.0 - shape.q);
  return shape.q < kSmoothLineQ && tail > threshold * std::exp(1.5 * (shape.q - 1.0));
}

double cusp_digits(Distribution distribution, Masking masking, const SlopeShape& shape) {
  if (masking != Masking::kSmith || distribution != Distribution::kCauchy) return kNoCusp;
  const double from_integer = std::abs(shape.q - std::round(shape.q));
  if (from_integer == 0.0) return kNoCusp;
  const double width = std::min(1.0, std::numbers::sqrt2 * shape.sigma);
  return (2.0 * shape.q - 2.0) * std::log10(width) + std::log10(std::min(1.0, 4.0 * from_integer)) -
         rule_model(masking).cusp_digits;
}

}  // namespace dolp
