#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fit/model.hpp"

namespace dolp::fit {

/// The residuals at a point in the space of the coordinates, and their derivatives.
struct Linearisation {
  Eigen::VectorXd at;  ///< coordinates in [0, 1]
  /// (model - measured) / uncertainty, or model - measured. Empty if not known yet; NaN where the model has no value.
  Eigen::VectorXd residuals = {};
  Eigen::MatrixXd jacobian = {};     ///< measurements x parameters; empty if not known yet
  Eigen::MatrixX2d components = {};  ///< Prediction::components at the point
  Eigen::VectorXd steps = {};        ///< steps of the next differences; empty before the first
};

enum class Differences {
  kForward,  ///< one neighbour per parameter, which is enough to find the way
  kCentral,  ///< two neighbours per parameter, on both sides if the range allows it
};

/// The residuals as a function of the parameters' coordinates.
class Residuals {
 public:
  /// The model and the evaluator must outlive the object. `tolerance`: tolerance of the model's values.
  Residuals(const Model& model, double tolerance, Differences differences, ModelEvaluator& evaluator,
            Progress progress);

  const Model& model() const { return model_; }
  double tolerance() const { return tolerance_; }
  std::size_t evaluations() const { return evaluations_; }  ///< parameter sets computed so far

  /// at() computes residuals in one batch, linearise() their derivatives by differences in another batch.
  std::vector<Linearisation> at(const std::vector<Eigen::VectorXd>& points);
  void linearise(const std::vector<Linearisation*>& points);

  Eigen::VectorXd values(const Eigen::VectorXd& point) const;
  std::vector<Prediction> predict(const std::vector<Eigen::VectorXd>& points);
  /// The values of the observables from Prediction::components.
  Eigen::VectorXd observed(const Eigen::MatrixX2d& components) const;
  const Eigen::VectorXd& weights() const { return weights_; }  ///< 1 / uncertainty, or 1 without uncertainties

 private:
  void differentiate(Linearisation& point, Eigen::Index j, const Prediction* beside, std::size_t count) const;
  double next_step(double step, const Linearisation& point, const Prediction& beside) const;

  const Model& model_;
  double tolerance_;
  Differences differences_;
  ModelEvaluator& evaluator_;
  Progress progress_;
  Eigen::VectorXd measured_, weights_;
  std::vector<bool> is_length_;  ///< per measurement: true for DOLP, which is the length of its components
  std::size_t evaluations_ = 0;
};

}  // namespace dolp::fit
