#include "plan/rule_nodes.hpp"

#include <algorithm>
#include <boost/math/special_functions/legendre.hpp>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <utility>

#include "base/parallel_ranges.hpp"

namespace dolp {
namespace {

using Nodes = std::vector<std::array<double, 2>>;

using Rule = std::vector<std::array<double, 2>>;

// Gauss rules by order; missing rules are computed on all cores.
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
      for (std::size_t i = first; i < last; ++i) *missing[i].second = gauss_legendre(missing[i].first);
    });
  }
  const Rule& of(int order) const { return rules_.at(order); }

 private:
  std::map<int, Rule> rules_;
};

void append_gauss(Nodes& nodes, const Rules& rules, int order) {
  for (const auto& [x, weight] : rules.of(order)) nodes.push_back({0.5 * (1.0 + x), 0.5 * weight});
}

void append_centre(Nodes& nodes, const Rules& rules, int order) {
  const Rule& rule = rules.of(order);
  nodes.insert(nodes.end(), rule.begin(), rule.end());
}

void append_half(Nodes& nodes, const Rules& rules, int order) {
  const Rule& rule = rules.of(2 * order);
  nodes.insert(nodes.end(), rule.begin() + order, rule.end());
}

// Midpoints psi of [0, pi] as tau = tan(psi/4), the weight chosen so that 4 / (1 + tau^2) * weight = pi / order.
void append_circle(Nodes& nodes, const Rules& /*rules*/, int order) {
  const double part = std::numbers::pi / order;
  for (int i = 0; i < order; ++i) {
    const double tau = std::tan(0.25 * part * (i + 0.5));
    nodes.push_back({tau, 0.25 * part * (1.0 + tau * tau)});
  }
}

void append_cluster(Nodes& nodes, const Rules& rules, int order) {
  for (const auto& [x, weight] : rules.of(order)) {
    const double v = 0.5 * (1.0 + x);
    nodes.push_back({v * v, v * weight});
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
