// Nodes of the Gauss rules that the kernel reads.
#pragma once

#include <array>
#include <vector>

namespace dolp {

/// Gauss-Legendre rule on [-1, 1], abscissae ascending.
/// Accuracy: 1e-15 (tests/compute/plan_test.cpp integrates polynomials of degree 2 * order - 1).
std::vector<std::array<double, 2>> gauss_legendre(int order);

/// The sections of shaders/physics/quadrature.glsl, orders 1 to `largest_order` each, as (abscissa, weight). Computed
/// once; the reference stays valid.
const std::vector<std::array<double, 2>>& rule_nodes(int largest_order);

}  // namespace dolp
