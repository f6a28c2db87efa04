// Least squares in a space of few dimensions.
#pragma once

#include <Eigen/Core>

namespace dolp {

/// Sums of columns nearest to given values, by orthonormal columns: Gram and Schmidt's, twice, which keeps them
/// orthogonal to rounding.
class LeastSquares {
 public:
  LeastSquares() = default;
  /// `columns` are linearly independent.
  explicit LeastSquares(const Eigen::MatrixXd& columns);

  /// The weight of each column in the sum that is nearest to `values`, and to 0 in the rows after those.
  Eigen::VectorXd solve(const Eigen::VectorXd& values) const;

 private:
  // Their product is the columns.
  Eigen::MatrixXd orthonormal_;
  Eigen::MatrixXd triangle_;
};

}  // namespace dolp
