#pragma once

#include <Eigen/Core>

namespace dolp::fit {

/// Orthonormal eigenvectors of a symmetric matrix without negative eigenvalues, the largest eigenvalue first.
struct PrincipalAxes {
  Eigen::VectorXd values;
  Eigen::MatrixXd directions;  ///< one in each column

  /// The inverse on the axes whose eigenvalue is above this share of the largest one, and 0 across them.
  Eigen::MatrixXd inverse(double least_share = 0.0) const;
};

PrincipalAxes principal_axes(const Eigen::MatrixXd& symmetric);

}  // namespace dolp::fit
