// Source: Trefethen, Approximation Theory and Approximation Practice (SIAM 2013), chapters 3 to 5 and 8.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace dolp {

/// The points cos(pi i / (count - 1)) on [-1, 1], descending. Domain: count >= 2.
std::vector<double> lobatto_points(Eigen::Index count);

/// Weights with which the values of a polynomial at `points` (lobatto_points) add up to its value at x in [-1, 1].
Eigen::RowVectorXd cardinal_values(const std::vector<double>& points, double x);

/// Matrix that turns values at lobatto_points(count) into Chebyshev coefficients of degree 0 to count - 1.
Eigen::MatrixXd chebyshev_coefficients(Eigen::Index count);

}  // namespace dolp
