#include "fit/principal_axes.hpp"

#include <Eigen/Eigenvalues>

namespace dolp::fit {

Eigen::MatrixXd PrincipalAxes::inverse(double least_share) const {
  const Eigen::VectorXd inverses =
      values.unaryExpr([least = least_share * values[0]](double value) { return value > least ? 1.0 / value : 0.0; });
  return directions * inverses.asDiagonal() * directions.transpose();
}

PrincipalAxes principal_axes(const Eigen::MatrixXd& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric);
  return {solver.eigenvalues().reverse().cwiseMax(0.0), solver.eigenvectors().rowwise().reverse()};
}

}  // namespace dolp::fit
