#include "plan/rule.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace dolp {
namespace {

constexpr std::array<RuleModel, 4> kModels = {{
    // none
    {.margin_digits = 0.3,
     .t_nodes = 2.19,
     .t_strip = 0.818,
     .t_strip_power = 0.105,
     .t_oblique = -0.048,
     .t_root_nodes = 1.63,
     .t_curvature = 0.032,
     .phi_half_nodes = 1.29,
     .phi_centre_nodes = 0.5,
     .strip = {1.77, 1.5, 1.1},
     .phi_grazing = 1.03,
     .phi_curvature = 0.003,
     .phi_circle_nodes = 1.4,
     .phi_circle_growth = 0.9,
     .phi_cluster_growth = 1.8},
    // v-cavity
    {.margin_digits = 0.3,
     .t_nodes = 2.91,
     .t_strip = 0.839,
     .t_strip_power = 0.107,
     .t_oblique = -0.129,
     .t_root_nodes = 0.807,
     .t_curvature = 0.0874,
     .phi_half_nodes = 1.18,
     .phi_centre_nodes = 0.966,
     .strip = {1.5, 1.3, 0.902},
     .phi_grazing = 0.653,
     .phi_curvature = 0.007,
     .phi_circle_nodes = 1.72,
     .phi_circle_growth = 0.966,
     .phi_cluster_growth = 1.8},
    // integral
    {.margin_digits = 0.3,
     .t_nodes = 2.54,
     .t_strip = 0.859,
     .t_strip_power = 0.119,
     .t_oblique = 0.099,
     .t_root_nodes = 1.23,
     .t_curvature = 0.113,
     .phi_half_nodes = 1.15,
     .phi_centre_nodes = 1.27,
     .strip = {1.85, 1.32, 0.902},
     .phi_grazing = 0.229,
     .phi_curvature = 0.103,
     .phi_circle_nodes = 1.38,
     .phi_circle_growth = 2.11,
     .phi_cluster_growth = 1.85,
     .line_threshold = 40.4},
    // smith
    {.margin_digits = 0.3,
     .t_nodes = 2.3,
     .t_strip = 0.501,
     .t_strip_power = 0.098,
     .t_oblique = -0.146,
     .t_root_nodes = 1.03,
     .t_curvature = 0.228,
     .phi_half_nodes = 1.82,
     .phi_centre_nodes = 0.529,
     .strip = {0.997, 1.1, 1.13},
     .phi_grazing = 0.148,
     .phi_curvature = 0.26,
     .phi_circle_nodes = 1.38,
     .phi_circle_growth = 1.8,
     .phi_cluster_growth = 2.38,
     .cusp_digits = 1.05,
     .line_threshold = 133.0},
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
  node.t_root_nodes = model.t_root_nodes;
  node.phi_half_nodes = model.phi_half_nodes;
  node.phi_centre_nodes = model.phi_centre_nodes;
  node.phi_circle_nodes = model.phi_circle_nodes;
  node.phi_growth = curved(model.phi_curvature, digits);
  node.phi_circle_growth = node.phi_growth * model.phi_circle_growth;
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
