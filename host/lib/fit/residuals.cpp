#include "fit/residuals.hpp"
#include "fit/constants.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dolp::fit {
namespace {

/// The derivative at 0 of the line, or the parabola, through the values at 0 and at the offsets.
Eigen::MatrixX2d derivative(const Eigen::MatrixX2d& at_0, const Prediction* beside,
                            const std::vector<double>& offsets) {
  const double a = offsets.front();
  if (offsets.size() == 1) return (beside[0].components - at_0) / a;
  const double b = offsets.back();
  return (beside[0].components - at_0) * (b / (a * (b - a))) - (beside[1].components - at_0) * (a / (b * (b - a)));
}

}  // namespace

Residuals::Residuals(const Model& model, double tolerance, Differences differences, ModelEvaluator& evaluator,
                     Progress progress)
    : model_(model),
      tolerance_(tolerance),
      differences_(differences),
      evaluator_(evaluator),
      progress_(std::move(progress)),
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

std::vector<Prediction> Residuals::predict(const std::vector<Eigen::VectorXd>& points) {
  if (points.empty()) return {};
  std::vector<Eigen::VectorXd> sets;
  sets.reserve(points.size());
  for (const Eigen::VectorXd& point : points) sets.push_back(values(point));
  evaluations_ += points.size();
  return model_.predict(sets, tolerance_, evaluator_, progress_);
}

Eigen::VectorXd Residuals::observed(const Eigen::MatrixX2d& components) const {
  Eigen::VectorXd values = components.col(0);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (is_length_[static_cast<std::size_t>(i)]) values[i] = components.row(i).norm();
  }
  return values;
}

std::vector<Linearisation> Residuals::at(const std::vector<Eigen::VectorXd>& points) {
  std::vector<Linearisation> found;
  std::vector<Prediction> predictions = predict(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::VectorXd residuals = (observed(predictions[i].components) - measured_).cwiseProduct(weights_);
    found.push_back({points[i], residuals, {}, std::move(predictions[i].components)});
  }
  return found;
}

void Residuals::linearise(const std::vector<Linearisation*>& points) {
  std::vector<std::vector<std::vector<double>>> offsets;  // of each point and parameter
  std::vector<Eigen::VectorXd> beside;
  for (Linearisation* const point : points) {
    offsets.push_back(offsets_of(*point));
    for (std::size_t j = 0; j < offsets.back().size(); ++j) {
      for (const double offset : offsets.back()[j]) {
        beside.push_back(point->at);
        beside.back()[static_cast<Eigen::Index>(j)] += offset;
      }
    }
  }
  const std::vector<Prediction> predictions = predict(beside);
  const Prediction* next = predictions.data();
  for (std::size_t i = 0; i < points.size(); ++i) {
    differentiate(*points[i], offsets[i], next);
    for (const std::vector<double>& of_parameter : offsets[i]) next += of_parameter.size();
  }
}

/// Offsets beside each coordinate that stay in [0, 1].
std::vector<std::vector<double>> Residuals::offsets_of(Linearisation& point) const {
  if (point.steps.size() == 0) point.steps = Eigen::VectorXd::Constant(point.at.size(), kFirstStep);
  std::vector<std::vector<double>> offsets;
  for (Eigen::Index j = 0; j < point.at.size(); ++j) {
    const double at = point.at[j];
    const double step = point.steps[j];
    const double inward = at + step > 1.0 ? -step : step;
    offsets.push_back({inward});
    const bool has_both_sides = at - step >= 0.0 && at + step <= 1.0;
    if (differences_ == Differences::kCentral) offsets.back().push_back(has_both_sides ? -step : 2.0 * inward);
  }
  return offsets;
}

void Residuals::differentiate(Linearisation& point, const std::vector<std::vector<double>>& offsets,
                              const Prediction* beside) const {
  const Eigen::MatrixX2d& centre = point.components;
  point.jacobian.resize(measured_.size(), point.at.size());
  for (Eigen::Index j = 0; j < point.at.size(); ++j) {
    const std::vector<double>& own = offsets[static_cast<std::size_t>(j)];
    const Eigen::MatrixX2d slopes = derivative(centre, beside, own);
    for (Eigen::Index i = 0; i < slopes.rows(); ++i) {
      // The length of (Q, U)/I has a kink where its components change sign; they have none.
      const double length = is_length_[static_cast<std::size_t>(i)] ? centre.row(i).norm() : 0.0;
      const double slope = length > 0.0 ? centre.row(i).dot(slopes.row(i)) / length : slopes(i, 0);
      point.jacobian(i, j) = weights_[i] * slope;
    }
    point.steps[j] = next_step(point.steps[j], point, *beside);
    beside += own.size();
  }
}

// A central difference with a step s has the error e/s of values that are wrong by e, and s^2 F/L^3 of a function of
// size F that varies over a length L. Their sum is least where the function changes by (3 e F^2)^(1/3). A change of a
// fifth of an uncertainty is enough where the values' error is far below it.
double Residuals::next_step(double step, const Linearisation& point, const Prediction& beside) const {
  const double change = (beside.components - point.components).cwiseAbs().maxCoeff();
  if (!std::isfinite(change) || change <= 0.0) return step;
  const double largest = point.components.cwiseAbs().maxCoeff();
  // Smaller bounds leave out what they cannot know.
  const double error = std::clamp(beside.error.maxCoeff(), 1e-3 * tolerance_, tolerance_);
  const double balanced = std::cbrt(3.0 * error * largest * largest);
  const double seen = std::max(kSeenShare / weights_.maxCoeff(), kErrorsOfAChange * error);
  const double factor = std::clamp(std::min(balanced, seen) / change, 1.0 / kMostChangeOfStep, kMostChangeOfStep);
  return std::clamp(step * factor, kLeastStep, kMostStep);
}

}  // namespace dolp::fit
