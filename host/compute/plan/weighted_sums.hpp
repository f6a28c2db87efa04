// Sums of known results with known weights: of the moments at nodes, and of responses. The order of the terms is fixed.
// With Eigen's order, results would depend on how a grid is divided.
#pragma once

#include <Eigen/Core>

namespace dolp {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Sums of the rows of known results, with one row of weights for each sum: a matrix product.
template <class Weights, class Rows>
RowMajor weighted_sums(const Weights& weights, const Rows& rows) {
  RowMajor sums = RowMajor::Zero(weights.rows(), rows.cols());
  for (Eigen::Index i = 0; i < weights.rows(); ++i) {
    for (Eigen::Index j = 0; j < weights.cols(); ++j) {  // skips weights of 0, because 0 times an infinite bound is NaN
      if (weights(i, j) != 0.0) sums.row(i) += weights(i, j) * rows.row(j);
    }
  }
  return sums;
}

/// The sum of each row of `values`. `weights` has a row for each of them, or one row for all.
template <class Weights, class Values>
Eigen::ArrayXd weighted_row_sums(const Weights& weights, const Values& values) {
  Eigen::ArrayXd sums = Eigen::ArrayXd::Zero(values.rows());
  const bool is_shared = weights.rows() == 1;
  for (Eigen::Index j = 0; j < weights.cols(); ++j) {
    if (!is_shared) sums += (weights.col(j) == 0.0).select(0.0, weights.col(j) * values.col(j));
    if (is_shared && weights(0, j) != 0.0) sums += weights(0, j) * values.col(j);
  }
  return sums;
}

}  // namespace dolp
