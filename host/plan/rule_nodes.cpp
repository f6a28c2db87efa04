#include "plan/rule_nodes.hpp"

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/math/special_functions/legendre.hpp>
#include <cmath>
#include <map>
#include <mutex>

namespace dolp {
namespace {

using Rule = std::vector<std::array<double, 2>>;
using Nodes = std::vector<std::array<double, 4>>;

// (2k + 1) P_k(x), which takes the coefficient of P_k out of a function; nothing for k < 1, where that is its mean.
double coefficient(int degree, double x) {
  return degree < 1 ? 0.0 : (2.0 * degree + 1.0) * boost::math::legendre_p(degree, x);
}

// Both null weights of the azimuth as one; a rule of one or two nodes tells apart no more than one degree, or none but
// the mean.
double both(int order, double first, double second) { return order > 2 ? first + second : first; }

void append_gauss(Nodes& nodes, int order) {
  for (const auto& [x, weight] : gauss_legendre(order)) {
    const double w = 0.5 * weight;
    nodes.push_back({0.5 * (1.0 + x), w, w * coefficient(order - 1, x), w * coefficient(order - 2, x)});
  }
}

void append_centre(Nodes& nodes, int order) {
  for (const auto& [x, weight] : gauss_legendre(order)) {
    const double null = order == 1 ? 1.0 : both(order, coefficient(order - 1, x), coefficient(order - 2, x));
    nodes.push_back({x, weight, weight * null, 0.0});
  }
}

void append_half(Nodes& nodes, int order) {
  const Rule rule = gauss_legendre(2 * order);
  for (auto node = rule.begin() + order; node != rule.end(); ++node) {
    const auto& [x, weight] = *node;
    const double null = order == 1 ? 1.0 : both(order, coefficient(2 * order - 2, x), coefficient(2 * order - 4, x));
    nodes.push_back({x, weight, weight * null, 0.0});
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
void append_circle(Nodes& nodes, int order) {
  for (int i = 0; i < order; ++i) {
    const double part = boost::math::constants::pi<double>() / order;
    const double psi = part * (i + 0.5);
    const double tau = std::tan(0.25 * psi);
    const double weight = 0.25 * part * (1.0 + tau * tau);
    nodes.push_back({tau, weight, weight * circle_null(order, psi), 0.0});
  }
}

void append_cluster(Nodes& nodes, int order) {
  for (const auto& [x, weight] : gauss_legendre(order)) {
    const double v = 0.5 * (1.0 + x);
    const double null = order == 1 ? 1.0 : both(order, coefficient(order - 1, x), coefficient(order - 2, x));
    nodes.push_back({v * v, v * weight, v * weight * null, 0.0});
  }
}

Nodes make_rule_nodes(int largest_order) {
  Nodes nodes;
  for (const auto append : {append_gauss, append_centre, append_half, append_circle, append_cluster}) {
    for (int order = 1; order <= largest_order; ++order) append(nodes, order);
  }
  return nodes;
}

}  // namespace

Rule gauss_legendre(int order) {
  Rule nodes;
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
  static std::map<int, Nodes> known;
  const std::lock_guard lock(mutex);
  const auto [found, is_new] = known.try_emplace(largest_order);
  if (is_new) found->second = make_rule_nodes(largest_order);
  return found->second;
}

}  // namespace dolp
