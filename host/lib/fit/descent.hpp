#pragma once

#include <Eigen/Core>
#include <dolp/fit.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "fit/residuals.hpp"

namespace dolp::fit {

/// Eigenvalues and orthonormal eigenvectors of a positive semidefinite matrix, the largest eigenvalue first.
struct PrincipalAxes {
  Eigen::VectorXd values;
  Eigen::MatrixXd directions;  ///< one eigenvector per column

  /// The inverse on the axes whose eigenvalue is above this share of the largest one, and 0 on the others.
  Eigen::MatrixXd inverse(double least_share = 0.0) const;
};

PrincipalAxes principal_axes(const Eigen::MatrixXd& symmetric);

/// The sum of the losses of all residuals; chi^2 with Loss::kSquares. Infinite if a residual is not finite.
double objective(const Eigen::VectorXd& residuals, Loss loss);

/// The weight of each residual in the normal equations, at most 1.
Eigen::VectorXd loss_weights(const Eigen::VectorXd& residuals, Loss loss);

struct DescentOptions {
  Loss loss = Loss::kSquares;
  double scale = 1.0;  ///< change of the objective by one standard deviation, or a guess of it
  int most_steps = 40;
  /// A descent ends when derivatives promise a decrease of the objective below this times the scale.
  double least_gain = 1e-5;
  /// If set, Broyden's updates replace fresh derivatives as long as they predict the steps. A descent that ends below
  /// this objective may end with updated derivatives; one that ends above it gets fresh ones.
  std::optional<double> secant_below = {};
};

/// The point where a descent begins and, after descend(), where it has ended.
struct Minimum {
  Linearisation where;                  ///< coordinates; also residuals and Jacobian if they are known already
  std::vector<Eigen::Index> held = {};  ///< positions of parameters that do not move
  double objective = 0.0;               ///< infinite if the model has no value here
  bool has_converged = false;
  double radius = 0.1;  ///< radius of the trust region; at 1, a move across a range costs one standard deviation
};

/// Descends from all points together by Levenberg-Marquardt within the bounds. Each step computes one batch of the
/// tried points, and one batch of all finite differences. Errors: errors of the evaluator; Cancelled.
void descend(Residuals& residuals, std::vector<Minimum>& all, const DescentOptions& options);

/// A point to be found beside a known one. Some of its coordinates are given and held; the others follow by a descent.
struct Neighbour {
  const Minimum* near;
  std::vector<Eigen::Index> held;
  Eigen::VectorXd to;  ///< coordinates of the point; only the held ones are used
};

/// Finds, for each neighbour, the least objective at its held coordinates. Derivatives at the known point lead the
/// other parameters to the bottom of the valley; from there they descend.
std::vector<Minimum> follow(Residuals& residuals, const std::vector<Neighbour>& all, const DescentOptions& options);

/// The coordinates to which the derivatives at the known point lead, and the sum of squares that they predict there.
std::pair<Eigen::VectorXd, double> predict_step(const Neighbour& neighbour, double scale);

/// True if the derivatives at `from` predict the residuals at `to`.
bool is_straight(const Linearisation& from, const Linearisation& to, double scale);

}  // namespace dolp::fit
