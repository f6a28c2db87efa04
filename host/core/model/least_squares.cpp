#include "model/least_squares.hpp"

namespace dolp {

LeastSquares::LeastSquares(const Eigen::MatrixXd& columns)
    : orthonormal_(columns), triangle_(Eigen::MatrixXd::Zero(columns.cols(), columns.cols())) {
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    Eigen::VectorXd own = columns.col(i);
    const auto before = orthonormal_.leftCols(i);
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::VectorXd parts = before.transpose() * own;
      own -= before * parts;
      triangle_.col(i).head(i) += parts;
    }
    triangle_(i, i) = own.norm();
    orthonormal_.col(i) = own / triangle_(i, i);
  }
}

Eigen::VectorXd LeastSquares::solve(const Eigen::VectorXd& values) const {
  Eigen::VectorXd weights = orthonormal_.topRows(values.size()).transpose() * values;
  for (Eigen::Index i = weights.size() - 1; i >= 0; --i) {
    weights[i] /= triangle_(i, i);
    weights.head(i) -= weights[i] * triangle_.col(i).head(i);
  }
  return weights;
}

}  // namespace dolp
