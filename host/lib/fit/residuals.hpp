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
  Eigen::VectorXd residuals = {};
  Eigen::MatrixXd jacobian = {};     ///< measurements x parameters; empty before it is computed
  Eigen::MatrixX2d components = {};  ///< Prediction::components at the point
  Eigen::VectorXd steps = {};        ///< steps for the next finite differences; empty before the first ones
};

enum class Differences {
  kForward,  ///< one neighbour per parameter: less accurate, but enough for a descent
  kCentral,  ///< two neighbours per parameter, on both sides if the range allows it
};

class Residuals {
 public:
  /// The model and the evaluator must outlive the object. `tolerance` is the tolerance of the model's values.
  Residuals(const Model& model, double tolerance, Differences differences, ModelEvaluator& evaluator,
            Progress progress);

  const Model& model() const { return model_; }
  double tolerance() const { return tolerance_; }
  std::size_t evaluations() const { return evaluations_; }  ///< number of parameter sets computed so far

  /// at() computes residuals, linearise() computes derivatives. Each function computes all points in one batch.
  std::vector<Linearisation> at(const std::vector<Eigen::VectorXd>& points);
  void linearise(const std::vector<Linearisation*>& points);

  Eigen::VectorXd values(const Eigen::VectorXd& point) const;
  std::vector<Prediction> predict(const std::vector<Eigen::VectorXd>& points);
  Eigen::VectorXd observed(const Eigen::MatrixX2d& components) const;
  const Eigen::VectorXd& weights() const { return weights_; }  ///< 1 / uncertainty; 1 without uncertainties

 private:
  void differentiate(Linearisation& point, Eigen::Index j, const Prediction* beside, std::size_t count) const;
  double next_step(double step, const Linearisation& point, const Prediction& beside) const;

  const Model& model_;
  double tolerance_;
  Differences differences_;
  ModelEvaluator& evaluator_;
  Progress progress_;
  Eigen::VectorXd measured_, weights_;
  std::vector<bool> is_length_;  ///< for each measurement: true if it is DOLP, the length of (Q/I, U/I)
  std::size_t evaluations_ = 0;
};

}  // namespace dolp::fit
