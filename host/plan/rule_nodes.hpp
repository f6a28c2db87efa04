// Abscissae and weights of the Gauss rules that the kernel reads.
#pragma once

#include <array>
#include <vector>

namespace dolp {

/// Gauss-Legendre rule on [-1, 1], abscissae ascending.
/// Accuracy: 1e-15 (tests/plan_test.cpp integrates polynomials of degree 2 * order - 1).
std::vector<std::array<double, 2>> gauss_legendre(int order);

/// The sections of shaders/physics/quadrature.glsl, orders 1 to DOLP_MAX_ORDER each, as (abscissa, weight) pairs.
std::vector<std::array<double, 2>> rule_nodes();

}  // namespace dolp
