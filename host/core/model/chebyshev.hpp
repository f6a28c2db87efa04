// Polynomial interpolation at Chebyshev-Lobatto points. Source: Trefethen, Approximation Theory and Approximation
// Practice (SIAM 2013), chapters 3 to 5 and 8.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace dolp {

/// The points cos(pi i / (count - 1)) on [-1, 1], descending. Domain: count >= 2.
std::vector<double> lobatto_points(Eigen::Index count);

/// Weights of the values at the Chebyshev-Lobatto `points` in the interpolating polynomial at x in [-1, 1]. They add up
/// to 1.
Eigen::RowVectorXd cardinal_values(const std::vector<double>& points, double x);

/// Matrix that turns values at lobatto_points(count) into the coefficients of Chebyshev polynomials of degree 0 to
/// count - 1.
Eigen::MatrixXd chebyshev_coefficients(Eigen::Index count);

}  // namespace dolp
