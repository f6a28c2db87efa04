// One-dimensional quadrature rules, from which product rules are made.
#pragma once

#include <cstddef>
#include <vector>

namespace dolp::bench {

/// Nodes and weights of a rule on [0, 1].
struct Rule {
  std::vector<double> nodes;
  std::vector<double> weights;
};

Rule midpoint_rule(std::size_t count);
/// The Gauss-Legendre rule.
Rule gauss_rule(std::size_t count);

}  // namespace dolp::bench
