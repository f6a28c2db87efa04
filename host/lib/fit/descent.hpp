// Descents from points of the parameters to the minima below them, all at once.
#pragma once

#include <Eigen/Core>
#include <dolp/fit.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "fit/residuals.hpp"

namespace dolp::fit {

/// Orthonormal eigenvectors of a symmetric matrix without negative eigenvalues, the largest eigenvalue first.
struct PrincipalAxes {
  Eigen::VectorXd values;
  Eigen::MatrixXd directions;  ///< one in each column

  /// The inverse on the axes whose eigenvalue is above this share of the largest one, and 0 across them.
  Eigen::MatrixXd inverse(double least_share = 0.0) const;
};

PrincipalAxes principal_axes(const Eigen::MatrixXd& symmetric);

/// The sum of the loss over all residuals: chi^2 without a robust loss; infinite where a residual is not finite.
double objective(const Eigen::VectorXd& residuals, Loss loss);

/// The weight of each residual in the normal equations, at most 1.
Eigen::VectorXd loss_weights(const Eigen::VectorXd& residuals, Loss loss);

struct DescentOptions {
  Loss loss = Loss::kSquares;
  double scale = 1.0;  ///< change of the objective by one standard deviation, at least about
  int most_steps = 40;
  double least_gain = 1e-5;  ///< over the scale: a descent ends where derivatives promise less
  /// Derivatives are updated from the steps (Broyden) as long as they predict them. Descents below this objective may
  /// end with updated derivatives; descents above end with fresh ones. None: all derivatives are fresh.
  std::optional<double> secant_below = {};
};

/// The beginning of a descent, and its end.
struct Minimum {
  Linearisation where;                  ///< coordinates; residuals and Jacobian where they are known already
  std::vector<Eigen::Index> held = {};  ///< parameters that stay
  double objective = 0.0;               ///< infinite where the model has no value
  bool has_converged = false;
  double radius = 0.1;  ///< radius of the trust region: with 1, to move over a whole range costs one standard deviation
};

/// Levenberg-Marquardt within the bounds: in each step one batch of the points that are tried, and one of all
/// differences. Errors: errors of the evaluator; Cancelled.
void descend(Residuals& residuals, std::vector<Minimum>& all, const DescentOptions& options);

/// Coordinates that are held at new values, beside a known point from which the others follow.
struct Neighbour {
  const Minimum* near;
  std::vector<Eigen::Index> held;
  Eigen::VectorXd to;  ///< coordinates; only the held coordinates count
};

/// The least objective at held coordinates: derivatives lead the other parameters to the bottom of the valley there,
/// and they descend.
std::vector<Minimum> follow(Residuals& residuals, const std::vector<Neighbour>& all, const DescentOptions& options);

/// The coordinates to which derivatives lead, and the sum of squares that they predict there.
std::pair<Eigen::VectorXd, double> predict_step(const Neighbour& neighbour, double scale);

/// True where the derivatives at a point predict the residuals at another point.
bool is_straight(const Linearisation& from, const Linearisation& to, double scale);

}  // namespace dolp::fit
