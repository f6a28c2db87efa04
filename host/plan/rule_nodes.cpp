#include "plan/rule_nodes.hpp"

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/math/special_functions/legendre.hpp>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include "base/parallel_ranges.hpp"

namespace dolp {
namespace {

using Nodes = std::vector<std::array<double, 4>>;

// A node of the Gauss rule of one order, with what takes the highest coefficients out of a function: (2k + 1) P_k(x),
// nothing for k < 1, where that is its mean.
struct GaussNode {
  double x = 0.0;
  double weight = 0.0;
  double first = 0.0;   // k = order - 1
  double second = 0.0;  // k = order - 2
  double fourth = 0.0;  // k = order - 4
};
using Rule = std::vector<GaussNode>;

// Fills in the coefficients; the recurrence of Boost's legendre_p gives them all in one pass.
void add_coefficients(GaussNode& node, int order) {
  const auto scaled = [](int degree, long double p) { return (2.0 * degree + 1.0) * static_cast<double>(p); };
  long double before = 1.0L;
  long double p = static_cast<long double>(node.x);
  for (int degree = 1; degree < order; ++degree) {
    if (degree == order - 4) node.fourth = scaled(degree, p);
    if (degree == order - 2) node.second = scaled(degree, p);
    if (degree == order - 1) node.first = scaled(degree, p);
    const long double next =
        boost::math::legendre_next(static_cast<unsigned>(degree), static_cast<long double>(node.x), p, before);
    before = std::exchange(p, next);
  }
}

Rule make_rule(int order) {
  Rule rule;
  for (const auto& [x, weight] : gauss_legendre(order)) {
    rule.push_back({x, weight});
    add_coefficients(rule.back(), order);
  }
  return rule;
}

// Gauss rules by order; those that are missing are made on all cores.
class Rules {
 public:
  void require(const std::vector<int>& orders) {
    std::vector<std::pair<int, Rule*>> missing;
    for (const int order : orders) {
      const auto [found, is_new] = rules_.try_emplace(order);
      if (is_new) missing.emplace_back(order, &found->second);
    }
    constexpr std::size_t kRulesAtOnce = 4;
    parallel_ranges(missing.size(), kRulesAtOnce, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) *missing[i].second = make_rule(missing[i].first);
    });
  }
  const Rule& of(int order) const { return rules_.at(order); }

 private:
  std::map<int, Rule> rules_;
};

// Both null weights of the azimuth as one; a rule of one or two nodes tells apart no more than one degree, or none but
// the mean.
double both(int order, double first, double second) { return order > 2 ? first + second : first; }

void append_gauss(Nodes& nodes, const Rules& rules, int order) {
  for (const GaussNode& node : rules.of(order)) {
    const double w = 0.5 * node.weight;
    nodes.push_back({0.5 * (1.0 + node.x), w, w * node.first, w * node.second});
  }
}

void append_centre(Nodes& nodes, const Rules& rules, int order) {
  for (const GaussNode& node : rules.of(order)) {
    const double null = order == 1 ? 1.0 : both(order, node.first, node.second);
    nodes.push_back({node.x, node.weight, node.weight * null, 0.0});
  }
}

void append_half(Nodes& nodes, const Rules& rules, int order) {
  const Rule& rule = rules.of(2 * order);
  for (auto node = rule.begin() + order; node != rule.end(); ++node) {
    const double null = order == 1 ? 1.0 : both(order, node->second, node->fourth);
    nodes.push_back({node->x, node->weight, node->weight * null, 0.0});
  }
}

// cos(2 psi) is in the integrand of r_q whatever the rule, so that it says nothing.
double circle_null(int order, double psi) {
  if (order == 1) return 1.0;
  if (order <= 3) return 2.0 * std::cos(psi);
  if (order == 4) return 2.0 * std::cos(3.0 * psi);
  return 2.0 * std::cos((order - 1) * psi) + 2.0 * std::cos((order - 2) * psi);
}

// Midpoints psi of [0, pi] as tau = tan(psi/4), the weight chosen so that 4 / (1 + tau^2) * weight = pi / order.
void append_circle(Nodes& nodes, const Rules& /*rules*/, int order) {
  for (int i = 0; i < order; ++i) {
    const double part = boost::math::constants::pi<double>() / order;
    const double psi = part * (i + 0.5);
    const double tau = std::tan(0.25 * psi);
    const double weight = 0.25 * part * (1.0 + tau * tau);
    nodes.push_back({tau, weight, weight * circle_null(order, psi), 0.0});
  }
}

void append_cluster(Nodes& nodes, const Rules& rules, int order) {
  for (const GaussNode& node : rules.of(order)) {
    const double v = 0.5 * (1.0 + node.x);
    const double null = order == 1 ? 1.0 : both(order, node.first, node.second);
    nodes.push_back({v * v, v * node.weight, v * node.weight * null, 0.0});
  }
}

Nodes make_rule_nodes(Rules& rules, int largest_order) {
  std::vector<int> orders;
  for (int order = 1; order <= largest_order; ++order) orders.insert(orders.end(), {order, 2 * order});
  rules.require(orders);
  Nodes nodes;
  for (const auto append : {append_gauss, append_centre, append_half, append_circle, append_cluster}) {
    for (int order = 1; order <= largest_order; ++order) append(nodes, rules, order);
  }
  return nodes;
}

}  // namespace

std::vector<std::array<double, 2>> gauss_legendre(int order) {
  std::vector<std::array<double, 2>> nodes;
  for (const double x : boost::math::legendre_p_zeros<double>(order)) {  // the zeros >= 0
    const double slope = boost::math::legendre_p_prime(order, x);
    const double weight = 2.0 / ((1.0 - x) * (1.0 + x) * slope * slope);
    nodes.push_back({x, weight});
    if (x > 0.0) nodes.push_back({-x, weight});
  }
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

const Nodes& rule_nodes(int largest_order) {
  static std::mutex mutex;
  static Rules rules;
  static std::map<int, Nodes> known;
  const std::lock_guard lock(mutex);
  const auto [found, is_new] = known.try_emplace(largest_order);
  if (is_new) found->second = make_rule_nodes(rules, largest_order);
  return found->second;
}

}  // namespace dolp
