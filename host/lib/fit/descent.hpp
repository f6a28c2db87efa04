// Descent from one point of the parameters to the minimum below it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <dolp/fit.hpp>
#include <optional>
#include <string>

#include "fit/residuals.hpp"

namespace dolp::fit {

/// The sum over all residuals; without a robust loss chi^2.
double objective(const Eigen::VectorXd& residuals, Loss loss);

/// The weight of each residual in the normal equations, at most 1.
Eigen::VectorXd loss_weights(const Eigen::VectorXd& residuals, Loss loss);

struct DescentOptions {
  Loss loss = Loss::kSquares;
  double scale = 1.0;                  ///< a change of the objective by one standard deviation, at least about
  std::vector<std::size_t> held = {};  ///< parameters that stay
  int most_steps = 40;
  double radius = 0.1;       ///< of the trust region at first
  double least_gain = 1e-4;  ///< of the scale: a descent ends where derivatives promise less
};

struct Minimum {
  Linearisation where;
  double objective = 0.0;
  bool has_converged = false;
  double radius = 0.0;  ///< of the trust region at last, with which a descent may go on
};

/// Levenberg-Marquardt within the bounds (Ceres Solver): a call of the model for each step that is tried, and a batch
/// of all differences for each that is taken. `start` has coordinates; residuals and Jacobian where they are known
/// already. Errors: those of the evaluator; Cancelled.
Minimum descend(Residuals& residuals, const Linearisation& start, const DescentOptions& options);

}  // namespace dolp::fit
