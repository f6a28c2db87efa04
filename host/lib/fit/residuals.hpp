#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fit/model.hpp"

namespace dolp::fit {

/// The residuals at a point, and their derivatives with respect to its coordinates.
struct Linearisation {
  Eigen::VectorXd at;  ///< coordinates of the point: 0 to 1 over the range of each parameter
  /// (model - measured) / uncertainty; without uncertainties, model - measured. NaN if the model has no value.
  Eigen::VectorXd residuals;
  /// Square roots of the weights of the residuals in the normal equations. Only Loss::kSquares gives large residuals
  /// the full weight 1.
  Eigen::VectorXd weights;
  double objective = 0.0;         ///< Residuals::objective() of `residuals`
  double error = 0.0;             ///< bound of the length of the numerical error of `residuals`
  Eigen::MatrixX2d components;    ///< Prediction::components at the point
  Eigen::MatrixXd jacobian = {};  ///< measurements x parameters; empty before it is computed
  Eigen::VectorXd steps = {};     ///< steps for the next finite differences; empty before the first ones
};

enum class Differences {
  kForward,  ///< one neighbour per parameter: less accurate, but enough for a descent
  kCentral,  ///< two neighbours per parameter, on both sides if the range allows it
};

struct ResidualOptions {
  double tolerance;  ///< tolerance of the model's values
  Differences differences = Differences::kForward;
  Loss loss = Loss::kSquares;
  Progress progress = {};
};

class Residuals {
 public:
  /// The model and the evaluator must outlive the object.
  Residuals(const Model& model, ModelEvaluator& evaluator, ResidualOptions options);

  const Model& model() const { return model_; }
  double tolerance() const { return options_.tolerance; }
  std::size_t evaluations() const { return evaluations_; }  ///< number of parameter sets computed so far

  /// at() computes residuals, linearise() computes derivatives. Each function computes all points in one batch.
  std::vector<Linearisation> at(const std::vector<Eigen::VectorXd>& points);
  void linearise(const std::vector<Linearisation*>& points);

  /// The sum of the losses of all residuals; with Loss::kSquares it is chi^2. Infinite if a residual is not finite.
  double objective(const Eigen::VectorXd& residuals) const;
  std::vector<Prediction> predict(const std::vector<Eigen::VectorXd>& points);
  const Eigen::VectorXd& weights() const { return weights_; }  ///< 1 / uncertainty; 1 without uncertainties

 private:
  void differentiate(Linearisation& point, Eigen::Index j, const Prediction* beside, std::size_t count) const;
  double next_step(double step, const Linearisation& point, const Prediction& beside) const;

  const Model& model_;
  ModelEvaluator& evaluator_;
  ResidualOptions options_;
  Eigen::VectorXd measured_, weights_;
  std::vector<bool> is_length_;  ///< for each measurement: true if it is DOLP, the length of (Q/I, U/I)
  std::size_t evaluations_ = 0;
};

}  // namespace dolp::fit
