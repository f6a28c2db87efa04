#pragma once

#include <Eigen/Core>
#include <dolp/fit.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "fit/residuals.hpp"

namespace dolp::fit {

/// Eigenvalues (the largest first) and orthonormal eigenvectors of a positive semidefinite matrix.
struct PrincipalAxes {
  Eigen::VectorXd values;
  Eigen::MatrixXd directions;  ///< one eigenvector per column

  /// The pseudoinverse: 1 / eigenvalue for eigenvalues above this share of the largest one, 0 for the others.
  Eigen::MatrixXd inverse(double least_share = 0.0) const;
};

PrincipalAxes principal_axes(const Eigen::MatrixXd& symmetric);

struct DescentOptions {
  double scale = 1.0;  ///< rise of the objective at one standard deviation from a minimum; may be a guess
  int most_steps = 40;
  /// The descent ends if derivatives predict that the next step lowers the objective by less than least_gain * scale.
  double least_gain = 1e-5;
  /// If set, Broyden's updates replace computed derivatives as long as the updates predict the steps well. A descent
  /// that would end with an objective above this value first computes the derivatives again.
  std::optional<double> secant_below = {};
};

/// A point where a descent begins. descend() moves it to the point where the descent ends.
struct Minimum {
  Linearisation where;                  ///< without a Jacobian, if it is not known yet
  std::vector<Eigen::Index> held = {};  ///< parameters whose coordinates the descent must not change
  bool has_converged = false;
  double radius = 0.1;  ///< radius of the trust region, which limits the length of a step

  double objective() const { return where.objective; }  ///< infinite if the model has no value at the point
};

/// Descends from all points at the same time by Levenberg-Marquardt within the bounds. Each step takes one call of the
/// evaluator for the points to try, and one for the finite differences. Errors: errors of the evaluator; Cancelled.
void descend(Residuals& residuals, std::vector<Minimum>& all, const DescentOptions& options);

/// A minimum for follow() to find near the point `near`. For parameters in `held` it has the coordinates of `to`.
struct Neighbour {
  const Minimum* near;
  std::vector<Eigen::Index> held;
  Eigen::VectorXd to;  ///< a coordinate for each parameter; unused for parameters not in `held`
};

/// Minimises the objective with the held coordinates fixed. Begins where derivatives at `near` predict the minimum.
std::vector<Minimum> follow(Residuals& residuals, const std::vector<Neighbour>& all, const DescentOptions& options);

/// Predicts a neighbour from the derivatives at the point `near`: its coordinates and its sum of squared residuals.
std::pair<Eigen::VectorXd, double> predict_step(const Neighbour& neighbour, double scale);

/// True if the derivatives at `from` predict the residuals at `to`. kBent limits the error of the prediction.
bool is_straight(const Linearisation& from, const Linearisation& to, double scale);

}  // namespace dolp::fit
