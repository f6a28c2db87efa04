// Weighted residuals of a model and their derivatives.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "fit/model.hpp"

namespace dolp::fit {

/// Residuals at a point of the parameters' coordinates, and their derivatives.
struct Linearisation {
  Eigen::VectorXd at;         ///< coordinates in [0, 1]
  Eigen::VectorXd residuals;  ///< (model - measured) / uncertainty; without uncertainties model - measured
  Eigen::MatrixXd jacobian;   ///< observations x parameters; empty where it was not asked for
};

/// The Jacobian of `near` at another point whose residuals are known, by Broyden's update.
Linearisation moved(const Linearisation& near, const Eigen::VectorXd& at, const Eigen::VectorXd& residuals);

enum class Differences {
  kForward,  ///< one more point for each parameter: enough to find the way
  kCentral,  ///< two, on both sides inside of the range
};

/// The residuals as a function of the parameters' coordinates.
class Residuals {
 public:
  /// `tolerance`: of the model's values. The model and the evaluator outlive the object.
  Residuals(const Model& model, double tolerance, Differences differences, MomentsEvaluator& evaluator,
            Progress progress);

  const Model& model() const { return model_; }
  double tolerance() const { return tolerance_; }
  /// Parameter sets computed so far.
  std::size_t evaluations() const { return evaluations_; }

  /// The residuals alone, at several points in one batch. NaN where the model has no value.
  std::vector<Eigen::VectorXd> at(const std::vector<Eigen::VectorXd>& points);

  /// Residuals with derivatives by differences, all in one batch. The step sizes follow the model's changes at the last
  /// ones, see `follow`.
  Linearisation linearised(const Eigen::VectorXd& point);

  /// The model at several points in one batch.
  using Predict = std::function<std::vector<Prediction>(const std::vector<Eigen::VectorXd>& points)>;
  std::vector<Prediction> predict(const std::vector<Eigen::VectorXd>& points);
  /// A copy that leaves the computation to `predict`.
  Residuals asking(Predict predict) const;

  Eigen::VectorXd values(const Eigen::VectorXd& point) const;
  Prediction predicted(const Eigen::VectorXd& point);
  /// The observables of a prediction.
  Eigen::VectorXd observed(const Prediction& prediction) const;
  /// The factors of the differences: 1 / uncertainty, or 1.
  const Eigen::VectorXd& weights() const { return weights_; }

 private:
  Eigen::VectorXd weighted(const Prediction& prediction) const;
  void follow(std::size_t parameter, double change, double stated_error, double largest);

  const Model& model_;
  double tolerance_;
  Differences differences_;
  MomentsEvaluator& evaluator_;
  Progress progress_;
  Predict predict_;  ///< none: the evaluator
  std::vector<double> steps_;
  Eigen::VectorXd measured_, weights_;
  std::vector<bool> is_length_;  ///< of DOLP: the observable is the length of its components
  std::size_t evaluations_ = 0;
  Eigen::VectorXd last_point_;  ///< the last that was asked for alone: a step that is taken was tried before
  Prediction last_;             ///< there
};

}  // namespace dolp::fit
