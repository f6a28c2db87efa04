// Weighted residuals of a model and their derivatives.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fit/model.hpp"

namespace dolp::fit {

/// Residuals at a point of the parameters' coordinates, and their derivatives.
struct Linearisation {
  Eigen::VectorXd at;              ///< coordinates in [0, 1]
  Eigen::VectorXd residuals = {};  ///< (model - measured) / uncertainty; without uncertainties model - measured. Empty
                                   ///< where they are not known, NaN where the model has no value
  Eigen::MatrixXd jacobian = {};   ///< observations x parameters; empty where it is not known
  Eigen::MatrixX2d components = {};  ///< components of the model's prediction
  Eigen::VectorXd steps = {};        ///< steps of the next differences; empty: not known yet
};

enum class Differences {
  kForward,  ///< one more point for each parameter: enough to find the way
  kCentral,  ///< two more points for each parameter, on both sides inside of the range
};

/// The residuals as a function of the parameters' coordinates.
class Residuals {
 public:
  /// `tolerance`: tolerance of the model's values. The model and the evaluator outlive the object.
  Residuals(const Model& model, double tolerance, Differences differences, ModelEvaluator& evaluator,
            Progress progress);

  const Model& model() const { return model_; }
  double tolerance() const { return tolerance_; }
  /// Parameter sets computed so far.
  std::size_t evaluations() const { return evaluations_; }

  /// The residuals at several points in one batch, and their derivatives by differences in another.
  std::vector<Linearisation> at(const std::vector<Eigen::VectorXd>& points);
  void linearise(const std::vector<Linearisation*>& points);

  Eigen::VectorXd values(const Eigen::VectorXd& point) const;
  std::vector<Prediction> predict(const std::vector<Eigen::VectorXd>& points);
  /// The observables of a prediction.
  Eigen::VectorXd observed(const Eigen::MatrixX2d& components) const;
  /// The factors of the differences: 1 / uncertainty, or 1.
  const Eigen::VectorXd& weights() const { return weights_; }

 private:
  void differentiate(Linearisation& point, Eigen::Index j, const Prediction* beside, std::size_t count) const;
  double next_step(double step, const Linearisation& point, const Prediction& beside) const;

  const Model& model_;
  double tolerance_;
  Differences differences_;
  ModelEvaluator& evaluator_;
  Progress progress_;
  Eigen::VectorXd measured_, weights_;
  std::vector<bool> is_length_;  ///< for DOLP: the observable is the length of its components
  std::size_t evaluations_ = 0;
};

}  // namespace dolp::fit
