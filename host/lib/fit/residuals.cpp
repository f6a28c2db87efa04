#include "fit/residuals.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dolp::fit {
namespace {

constexpr double kFirstStep = 0.01;
constexpr double kLeastStep = 1e-6;
constexpr double kMostStep = 0.05;
constexpr double kLeastErrorShare = 1e-3;  // of the tolerance: smaller bounds leave out what they cannot know
constexpr double kSeenShare = 0.2;         // of an uncertainty
constexpr double kErrorsOfAChange = 100.0;
constexpr double kMostChangeOfStep = 10.0;  // from one linearisation to the next

/// Offsets beside a coordinate that stay in [0, 1].
std::vector<double> offsets(double coordinate, double step, Differences differences) {
  const double inward = coordinate + step > 1.0 ? -step : step;
  if (differences == Differences::kForward) return {inward};
  const bool has_both_sides = coordinate - step >= 0.0 && coordinate + step <= 1.0;
  return {inward, has_both_sides ? -step : 2.0 * inward};
}

/// The derivative at 0 of the line, or the parabola, through the values at 0 and at the offsets.
Eigen::MatrixX2d derivative(const Eigen::MatrixX2d& at_0, const Prediction* beside,
                            const std::vector<double>& offsets) {
  const double a = offsets.front();
  if (offsets.size() == 1) return (beside[0].components - at_0) / a;
  const double b = offsets.back();
  return (beside[0].components - at_0) * (b / (a * (b - a))) - (beside[1].components - at_0) * (a / (b * (b - a)));
}

}  // namespace

Linearisation moved(const Linearisation& near, const Eigen::VectorXd& at, const Eigen::VectorXd& residuals) {
  Linearisation result{at, residuals, near.jacobian};
  const Eigen::VectorXd step = at - near.at;
  if (step.squaredNorm() > 0.0 && residuals.allFinite()) {
    result.jacobian += (residuals - near.residuals - near.jacobian * step) * step.transpose() / step.squaredNorm();
  }
  return result;
}

Residuals::Residuals(const Model& model, double tolerance, Differences differences, MomentsEvaluator& evaluator,
                     Progress progress)
    : model_(model),
      tolerance_(tolerance),
      differences_(differences),
      evaluator_(evaluator),
      progress_(std::move(progress)),
      steps_(model.parameters().size(), kFirstStep),
      measured_(static_cast<Eigen::Index>(model.observation_count())),
      weights_(measured_.size()) {
  Eigen::Index row = 0;
  for (const MeasuredData& data : model.data()) {
    for (const Measurement& observation : data.measurements) {
      measured_[row] = observation.value;
      weights_[row++] = 1.0 / observation.uncertainty.value_or(1.0);
      is_length_.push_back(observation.observable == Observable::kDolp);
    }
  }
}

Eigen::VectorXd Residuals::values(const Eigen::VectorXd& point) const {
  Eigen::VectorXd values(point.size());
  for (Eigen::Index j = 0; j < point.size(); ++j) {
    values[j] = model_.parameters()[static_cast<std::size_t>(j)].at(point[j]);
  }
  return values;
}

Residuals Residuals::asking(Predict predict) const {
  Residuals copy = *this;
  copy.predict_ = std::move(predict);
  return copy;
}

std::vector<Prediction> Residuals::predict(const std::vector<Eigen::VectorXd>& points) {
  if (predict_) return predict_(points);
  std::vector<Eigen::VectorXd> sets;
  sets.reserve(points.size());
  for (const Eigen::VectorXd& point : points) sets.push_back(values(point));
  evaluations_ += points.size();
  return model_.predict(sets, tolerance_, evaluator_, progress_);
}

Prediction Residuals::predicted(const Eigen::VectorXd& point) { return std::move(predict({point}).front()); }

Eigen::VectorXd Residuals::observed(const Prediction& prediction) const {
  Eigen::VectorXd values = prediction.components.col(0);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (is_length_[static_cast<std::size_t>(i)]) values[i] = prediction.components.row(i).norm();
  }
  return values;
}

Eigen::VectorXd Residuals::weighted(const Prediction& prediction) const {
  return (observed(prediction) - measured_).cwiseProduct(weights_);
}

std::vector<Eigen::VectorXd> Residuals::at(const std::vector<Eigen::VectorXd>& points) {
  std::vector<Eigen::VectorXd> residuals;
  std::vector<Prediction> predictions = predict(points);
  for (const Prediction& prediction : predictions) residuals.push_back(weighted(prediction));
  if (points.size() == 1) {
    last_point_ = points.front();
    last_ = std::move(predictions.front());
  }
  return residuals;
}

Linearisation Residuals::linearised(const Eigen::VectorXd& point) {
  const bool is_last = last_point_.size() == point.size() && last_point_ == point;
  std::vector<Eigen::VectorXd> points;
  if (!is_last) points.push_back(point);
  std::vector<std::vector<double>> beside;
  for (Eigen::Index j = 0; j < point.size(); ++j) {
    beside.push_back(offsets(point[j], steps_[static_cast<std::size_t>(j)], differences_));
    for (const double offset : beside.back()) {
      points.push_back(point);
      points.back()[j] += offset;
    }
  }
  std::vector<Prediction> predictions = predict(points);
  if (is_last) predictions.insert(predictions.begin(), last_);
  const Eigen::MatrixX2d& centre = predictions.front().components;
  Linearisation result{point, weighted(predictions.front()), Eigen::MatrixXd(measured_.size(), point.size())};
  const Prediction* next = &predictions[1];
  for (Eigen::Index j = 0; j < point.size(); ++j) {
    const auto parameter = static_cast<std::size_t>(j);
    const Eigen::MatrixX2d slopes = derivative(centre, next, beside[parameter]);
    for (Eigen::Index i = 0; i < slopes.rows(); ++i) {
      // The length of (Q, U)/I has a kink where its components change sign; they have none.
      const double length = is_length_[static_cast<std::size_t>(i)] ? centre.row(i).norm() : 0.0;
      const double slope = length > 0.0 ? centre.row(i).dot(slopes.row(i)) / length : slopes(i, 0);
      result.jacobian(i, j) = weights_[i] * slope;
    }
    follow(parameter, (next->components - centre).cwiseAbs().maxCoeff(), next->error.maxCoeff(),
           centre.cwiseAbs().maxCoeff());
    next += beside[parameter].size();
  }
  return result;
}

// A central difference with a step s has the error e/s of values that are wrong by e, and s^2 F/L^3 of a function of
// size F that varies over a length L. Their sum is least where the function changes by (3 e F^2)^(1/3). A change of a
// fifth of an uncertainty is enough where the values' error is far below it.
void Residuals::follow(std::size_t parameter, double change, double stated_error, double largest) {
  if (!std::isfinite(change) || change <= 0.0) return;
  const double error = std::clamp(stated_error, kLeastErrorShare * tolerance_, tolerance_);
  const double balanced = std::cbrt(3.0 * error * largest * largest);
  const double seen = std::max(kSeenShare / weights_.maxCoeff(), kErrorsOfAChange * error);
  const double factor = std::clamp(std::min(balanced, seen) / change, 1.0 / kMostChangeOfStep, kMostChangeOfStep);
  steps_[parameter] = std::clamp(steps_[parameter] * factor, kLeastStep, kMostStep);
}

}  // namespace dolp::fit
