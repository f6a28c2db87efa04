#include "plan/rule.hpp"

#include <algorithm>
#include <array>
#include <boost/math/special_functions/legendre.hpp>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>

#include "base/numbers.hpp"
#include "base/parallel_ranges.hpp"
#include "model/slopes.hpp"
#include "plan/constants.hpp"

namespace dolp {
namespace {

// Found by `dolp-calibrate fit MASKING`; for all bounces, by `dolp-calibrate fit multiple --entries 60 --rounds 3`.
constexpr std::array<RuleModel, 5> kModels = {{
    // none
    {.margin_digits = 2.4, .t_nodes = 1.4, .t_digits = 0.5, .t_fall = 0.18, .phi_nodes = 0.362, .phi_digits = 0.25},
    // v-cavity
    {.margin_digits = 2.5, .t_nodes = 1, .t_digits = -0.812, .t_fall = 0.165, .phi_nodes = 0.562, .phi_digits = 0.188},
    // integral
    {.margin_digits = 2.4,
     .t_nodes = 2.15,
     .t_digits = -0.25,
     .t_fall = 0.225,
     .phi_nodes = 0.562,
     .phi_digits = -0.625},
    // smith
    {.margin_digits = 2.8,
     .t_nodes = 2.4,
     .t_digits = 0.25,
     .t_fall = 0.112,
     .phi_nodes = 0.3,
     .phi_digits = -0.5,
     .cluster_stretch = 5.5},
    // all bounces in grooves
    {.margin_digits = 2.4, .t_nodes = 2.3, .t_digits = -0.375, .t_fall = 0.09, .phi_nodes = 0.625, .phi_digits = 0},
}};

constexpr double kNone = -1000.0;
constexpr double kLeastCusp = 1e-3;  // of a smaller share of the cusp no rule takes notice
constexpr double kMostCuspPower = 10.0;

// log10 of the number of nodes on a piece with a kink of the masking. A slope width above 1 divides this number.
double decades_per_node(const SlopeShape& shape, double digits) {
  const double width = std::max(1.0, slope_width(shape));
  return std::log10(std::max(kNodesPerDigit * digits / width, 1.5));
}

// log10 of the error of a rule on a piece that contains the cusp of smith masking, at theta_r = 0. For Cauchy slopes,
// Smith's Lambda is proportional to tan(theta_r)^(2q-2) at the cusp. So n nodes give an error proportional to n^(-2q),
// if q is not large. For an integer q, Lambda has no cusp but branch points at tan(theta_r) = +-i / m. If m is large, n
// nodes cannot tell them from a cusp; if not, they reduce the error by exp(-2 n / m).
double unsplit_cusp(Distribution distribution, const SlopeShape& shape, double digits) {
  const double per_node = decades_per_node(shape, digits);
  if (distribution == Distribution::kGaussian) {
    // Gaussian slopes: all derivatives of Lambda are 0 at the cusp. At 45 degrees, Lambda is about exp(-1/(2 sigma^2)).
    return -0.5 / (shape.sigma * shape.sigma * std::numbers::ln10) - kGaussianCuspPower * per_node;
  }
  const double coefficient = gamma_ratio(shape.q - 1.0) / (kRootPi * (2.0 * shape.q - 3.0) * (2.0 * shape.q - 2.0));
  const double size =
      (2.0 * shape.q - 2.0) * std::log10(std::min(1.0, slope_width(shape))) + std::log10(std::min(coefficient, 1.0));
  const double from_integer = std::abs(shape.q - std::round(shape.q));
  const double seen = std::exp(-2.0 * std::pow(10.0, per_node) / slope_width(shape));
  const double share = std::max(std::min(1.0, 4.0 * from_integer), seen);
  return share < kLeastCusp ? kNone : size + std::log10(share) - std::min(2.0 * shape.q, kMostCuspPower) * per_node;
}

// log10 of the error of a rule across the kink of `integral` masking. G has a term |distance from the kink|^(2q-1).
double unsplit_line(Distribution distribution, const SlopeShape& shape, double digits) {
  if (distribution == Distribution::kGaussian) {
    return shape.sigma > (digits > kTightDigits ? kTightLineSigma : kLineSigma) ? 0.0 : kNone;
  }
  const double tail = (1.0 - shape.q) * std::log10(1.0 + 0.5 / (shape.sigma * shape.sigma));
  return tail - 2.0 * shape.q * decades_per_node(shape, digits);
}

using Rules = std::map<int, RuleNodes>;  // by order

void add_gauss_rules(Rules& rules, int largest_order) {
  std::vector<Rules::value_type*> missing;
  for (int i = 1; i <= largest_order; ++i) {
    for (const int order : {i, 2 * i}) {
      const auto [found, is_new] = rules.try_emplace(order);
      if (is_new) missing.push_back(&*found);
    }
  }
  constexpr std::size_t kRulesAtOnce = 4;
  parallel_for(missing.size(), kRulesAtOnce,
               [&](std::size_t i) { missing[i]->second = gauss_legendre(missing[i]->first); });
}

RuleNodes make_rule_nodes(const Rules& gauss, int largest_order) {
  std::array<RuleNodes, 5> sections;
  auto& [unit, centre, half, circle, cluster] = sections;
  for (int order = 1; order <= largest_order; ++order) {
    const RuleNodes& rule = gauss.at(order);
    for (const auto& [x, weight] : rule) {
      const double v = 0.5 * (1.0 + x);
      unit.push_back({v, 0.5 * weight});
      cluster.push_back({v * v, v * weight});
    }
    centre.insert(centre.end(), rule.begin(), rule.end());
    const RuleNodes& twice = gauss.at(2 * order);
    half.insert(half.end(), twice.begin() + order, twice.end());
    // Midpoints psi of equal parts of [0, pi]. The kernel uses tau = tan(psi/4), so the weights contain dtau/dpsi.
    const double part = std::numbers::pi / order;
    for (int i = 0; i < order; ++i) {
      const double tau = std::tan(0.25 * part * (i + 0.5));
      circle.push_back({tau, 0.25 * part * (1.0 + tau * tau)});
    }
  }
  RuleNodes nodes;
  for (const RuleNodes& section : sections) nodes.insert(nodes.end(), section.begin(), section.end());
  return nodes;
}

}  // namespace

RuleNodes gauss_legendre(int order) {
  RuleNodes nodes;
  for (const double x : boost::math::legendre_p_zeros<double>(order)) {  // the zeros that are not negative
    const double slope = boost::math::legendre_p_prime(order, x);
    const double weight = 2.0 / ((1.0 - x) * (1.0 + x) * slope * slope);
    nodes.push_back({x, weight});
    if (x > 0.0) nodes.push_back({-x, weight});
  }
  std::ranges::sort(nodes);
  return nodes;
}

const RuleNodes& rule_nodes(int largest_order) {
  static std::mutex mutex;
  static Rules gauss, known;
  const std::lock_guard lock(mutex);
  const auto [found, is_new] = known.try_emplace(largest_order);
  if (is_new) {
    add_gauss_rules(gauss, largest_order);
    found->second = make_rule_nodes(gauss, largest_order);
  }
  return found->second;
}

const RuleModel& rule_model(Masking masking, Scattering scattering) {
  return scattering == Scattering::kMultiple ? kModels.back() : kModels[static_cast<std::size_t>(masking)];
}

double rule_digits(const RuleModel& model, double tolerance) {
  return (model.margin_digits - std::log10(tolerance)) / kCoarseShare;
}

int largest_order(double digits) {
  return std::min(DOLP_MAX_ORDER, std::max(kPlainOrder, static_cast<int>(std::ceil(kOrderPerDigit * digits))));
}

int split_bounces(double digits) { return std::clamp(static_cast<int>(digits / kDigitsPerSplit), 1, DOLP_MOST_SPLITS); }

kernel::RuleNode rule_node(const RuleModel& model, double tolerance) {
  const double digits = rule_digits(model, tolerance);
  kernel::RuleNode node{};
  node.digits = digits;
  node.t_nodes = model.t_nodes;
  node.t_digits = model.t_digits;
  node.t_fall = model.t_fall;
  node.phi_nodes = model.phi_nodes;
  node.phi_digits = model.phi_digits;
  node.cluster_stretch = model.cluster_stretch;
  node.cluster_below_q = kClusterBelowQ * digits;
  node.split_bounces = split_bounces(digits);
  node.dimmest = kDimmest * tolerance;
  return node;
}

bool needs_line(Distribution distribution, Masking masking, const SlopeShape& shape, double digits, double tolerance) {
  const double allowed = std::log10(kLineShare * tolerance);
  if (masking == Masking::kSmith) return unsplit_cusp(distribution, shape, digits) > allowed;
  return masking == Masking::kIntegral && unsplit_line(distribution, shape, digits) > allowed;
}

double cusp_digits(Distribution distribution, Masking masking, const SlopeShape& shape, double digits) {
  return masking == Masking::kSmith ? unsplit_cusp(distribution, shape, digits) : kNone;
}

}  // namespace dolp
