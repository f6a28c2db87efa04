#include "plan/rule_nodes.hpp"

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/math/special_functions/legendre.hpp>
#include <cmath>

#include "plan/kernel_data.hpp"

namespace dolp {
namespace {

using Nodes = std::vector<std::array<double, 2>>;

void append_gauss(Nodes& nodes, int order) {
  for (const auto& [x, weight] : gauss_legendre(order)) nodes.push_back({0.5 * (1.0 + x), 0.5 * weight});
}

void append_centre(Nodes& nodes, int order) {
  const Nodes rule = gauss_legendre(order);
  nodes.insert(nodes.end(), rule.begin(), rule.end());
}

void append_half(Nodes& nodes, int order) {
  const Nodes rule = gauss_legendre(2 * order);
  nodes.insert(nodes.end(), rule.begin() + order, rule.end());
}

// Midpoints psi of [0, pi] as tau = tan(psi/4), the weight chosen so that 4 / (1 + tau^2) * weight = pi / order.
void append_circle(Nodes& nodes, int order) {
  for (int i = 0; i < order; ++i) {
    const double part = boost::math::constants::pi<double>() / order;
    const double tau = std::tan(0.25 * part * (i + 0.5));
    nodes.push_back({tau, 0.25 * part * (1.0 + tau * tau)});
  }
}

void append_cluster(Nodes& nodes, int order) {
  for (const auto& [x, weight] : gauss_legendre(order)) {
    const double v = 0.5 * (1.0 + x);
    nodes.push_back({v * v, v * weight});
  }
}

}  // namespace

Nodes gauss_legendre(int order) {
  Nodes nodes;
  for (const double x : boost::math::legendre_p_zeros<double>(order)) {  // the zeros >= 0
    const double slope = boost::math::legendre_p_prime(order, x);
    const double weight = 2.0 / ((1.0 - x) * (1.0 + x) * slope * slope);
    nodes.push_back({x, weight});
    if (x > 0.0) nodes.push_back({-x, weight});
  }
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

Nodes rule_nodes() {
  Nodes nodes;
  for (const auto append : {append_gauss, append_centre, append_half, append_circle, append_cluster}) {
    for (int order = 1; order <= DOLP_MAX_ORDER; ++order) append(nodes, order);
  }
  return nodes;
}

}  // namespace dolp
