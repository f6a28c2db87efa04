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

  /// The pseudoinverse: 1 / eigenvalue for eigenvalues above this share of the largest one, 0 for the others.
  Eigen::MatrixXd inverse(double least_share = 0.0) const;
};

PrincipalAxes principal_axes(const Eigen::MatrixXd& symmetric);

/// The sum of the losses of all residuals, which is chi^2 with Loss::kSquares. Infinite if a residual is not finite.
double objective(const Eigen::VectorXd& residuals, Loss loss);

/// The weight of each residual in the normal equations, which a loss reduces below 1 for outliers.
Eigen::VectorXd loss_weights(const Eigen::VectorXd& residuals, Loss loss);

struct DescentOptions {
  Loss loss = Loss::kSquares;
  double scale = 1.0;  ///< rise of the objective one standard deviation from a minimum, perhaps guessed
  int most_steps = 40;
  /// A descent ends when derivatives promise that the objective falls by less than this times `scale`.
  double least_gain = 1e-5;
  /// If set, Broyden's updates replace new derivatives as long as they predict the steps well. A descent may end with
  /// updated derivatives if its objective is below this value; above it, the derivatives are computed anew.
  std::optional<double> secant_below = {};
};

/// The point where a descent begins and, after descend(), the point where it has ended.
struct Minimum {
  Linearisation where;                  ///< coordinates of the point; also residuals and Jacobian if known
  std::vector<Eigen::Index> held = {};  ///< positions of parameters whose coordinates are held fixed
  double objective = 0.0;               ///< infinite if the model has no value at the point
  bool has_converged = false;
  double radius = 0.1;  ///< radius of the trust region; 1: a move across a range costs a standard deviation
};

/// Descends from all points at the same time by Levenberg-Marquardt within the bounds. Each step takes one call of the
/// evaluator for the points to try, and one for the finite differences. Errors: errors of the evaluator; Cancelled.
void descend(Residuals& residuals, std::vector<Minimum>& all, const DescentOptions& options);

/// A point to find near a known point. Some of its coordinates are given and held fixed; a descent finds the others.
struct Neighbour {
  const Minimum* near;
  std::vector<Eigen::Index> held;
  Eigen::VectorXd to;  ///< coordinates of the new point; only those in `held` are used
};

/// Finds, for each neighbour, the lowest objective at its held coordinates. The derivatives at the known point predict
/// the other coordinates; a descent from there finds the minimum.
std::vector<Minimum> follow(Residuals& residuals, const std::vector<Neighbour>& all, const DescentOptions& options);

/// The coordinates that the derivatives at the known point predict for a neighbour, and the sum of squares there.
std::pair<Eigen::VectorXd, double> predict_step(const Neighbour& neighbour, double scale);

/// True if the derivatives at `from` predict the residuals at `to` well (see kBent).
bool is_straight(const Linearisation& from, const Linearisation& to, double scale);

}  // namespace dolp::fit
