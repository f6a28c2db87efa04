#include "fit/residuals.hpp"
#include "fit/constants.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace dolp::fit {
namespace {

/// A loss and its derivative with respect to the squared residual. The constants in the losses are chosen so that fits
/// to normally distributed errors have 95 % of the efficiency of least squares.
std::pair<double, double> loss_and_weight(double square, Loss loss) {
  switch (loss) {
    case Loss::kSquares:
      break;
    case Loss::kHuber: {
      constexpr double kWidth = 1.345;
      const double length = std::sqrt(square);
      if (length <= kWidth) break;
      return {2.0 * kWidth * length - kWidth * kWidth, kWidth / length};
    }
    case Loss::kSoftL1: {
      const double root = std::sqrt(1.0 + square);
      return {2.0 * (root - 1.0), 1.0 / root};
    }
    case Loss::kCauchy: {
      constexpr double kSquare = 2.385 * 2.385;
      return {kSquare * std::log1p(square / kSquare), 1.0 / (1.0 + square / kSquare)};
    }
    case Loss::kTukey: {
      constexpr double kSquare = 4.685 * 4.685;
      const double rest = std::max(0.0, 1.0 - square / kSquare);
      return {kSquare / 3.0 * (1.0 - rest * rest * rest), rest * rest};
    }
  }
  return {square, 1.0};
}

/// Offsets from a coordinate to its two neighbours. The signs are chosen so that both neighbours lie in [0, 1].
std::array<double, 2> offsets_at(double at, double step) {
  const double inward = at + step > 1.0 ? -step : step;
  const bool has_both_sides = at - step >= 0.0 && at + step <= 1.0;
  return {inward, has_both_sides ? -step : 2.0 * inward};
}

/// The derivative at a point, from a line (one neighbour) or a parabola (two neighbours) through the values.
Eigen::MatrixX2d derivative(const Eigen::MatrixX2d& centre, const Prediction* beside, std::size_t count,
                            const std::array<double, 2>& offsets) {
  const auto [a, b] = offsets;
  if (count == 1) return (beside[0].components - centre) / a;
  return (beside[0].components - centre) * (b / (a * (b - a))) - (beside[1].components - centre) * (a / (b * (b - a)));
}

}  // namespace

Residuals::Residuals(const Model& model, ModelEvaluator& evaluator, ResidualOptions options)
    : model_(model),
      evaluator_(evaluator),
      options_(std::move(options)),
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

std::vector<Prediction> Residuals::predict(const std::vector<Eigen::VectorXd>& points) {
  if (points.empty()) return {};
  std::vector<Eigen::VectorXd> sets;
  for (const Eigen::VectorXd& point : points) sets.push_back(model_.values(point));
  evaluations_ += points.size();
  return model_.predict(sets, options_.tolerance, evaluator_, options_.progress);
}

double Residuals::objective(const Eigen::VectorXd& residuals) const {
  if (!residuals.allFinite()) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const double residual : residuals) sum += loss_and_weight(residual * residual, options_.loss).first;
  return sum;
}

std::vector<Linearisation> Residuals::at(const std::vector<Eigen::VectorXd>& points) {
  std::vector<Linearisation> found;
  std::vector<Prediction> predictions = predict(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::VectorXd residuals = (predictions[i].values - measured_).cwiseProduct(weights_);
    const Eigen::VectorXd weights = residuals.unaryExpr(
        [this](double residual) { return std::sqrt(loss_and_weight(residual * residual, options_.loss).second); });
    const double error = predictions[i].error.cwiseProduct(weights_).norm();
    found.push_back({points[i], residuals, weights, objective(residuals), error, std::move(predictions[i].components)});
  }
  return found;
}

void Residuals::linearise(const std::vector<Linearisation*>& points) {
  const std::size_t count =
      options_.differences == Differences::kCentral ? 2 : 1;  // number of neighbours per parameter
  std::vector<Eigen::VectorXd> beside;
  for (Linearisation* const point : points) {
    if (point->steps.size() == 0) point->steps.setConstant(point->at.size(), kFirstStep);
    for (std::size_t i = 0; i < count * static_cast<std::size_t>(point->at.size()); ++i) {
      const auto j = static_cast<Eigen::Index>(i / count);
      beside.push_back(point->at);
      beside.back()[j] += offsets_at(point->at[j], point->steps[j])[i % count];
    }
  }
  const std::vector<Prediction> predictions = predict(beside);
  const Prediction* next = predictions.data();
  for (Linearisation* const point : points) {
    point->jacobian.resize(measured_.size(), point->at.size());
    for (Eigen::Index j = 0; j < point->at.size(); ++j, next += count) differentiate(*point, j, next, count);
  }
}

/// Sets column j of the Jacobian from the predictions at the neighbours. Sets the step of the next finite differences.
void Residuals::differentiate(Linearisation& point, Eigen::Index j, const Prediction* beside, std::size_t count) const {
  const Eigen::MatrixX2d& centre = point.components;
  const Eigen::MatrixX2d slopes = derivative(centre, beside, count, offsets_at(point.at[j], point.steps[j]));
  for (Eigen::Index i = 0; i < slopes.rows(); ++i) {
    // DOLP is the length of (Q/I, U/I), with a kink at 0. So its slope is computed from the slopes of Q/I and U/I.
    const double length = is_length_[static_cast<std::size_t>(i)] ? centre.row(i).norm() : 0.0;
    const double slope = length > 0.0 ? centre.row(i).dot(slopes.row(i)) / length : slopes(i, 0);
    point.jacobian(i, j) = weights_[i] * slope;
  }
  point.steps[j] = next_step(point.steps[j], point, *beside);
}

// A central difference with step s has two errors. If the model's values have the error e, the first is e/s. If they
// have the size F and vary over the length L, the second is s^2 F/(6 L^3). The sum is smallest for s = L (3 e/F)^(1/3).
// This step changes the values by F s/L = (3 e F^2)^(1/3), here called `balanced`. But a change of the size `seen` is
// large enough, see kSeenShare. So the next step aims at the smaller of the two changes.
double Residuals::next_step(double step, const Linearisation& point, const Prediction& beside) const {
  const double change = (beside.components - point.components).cwiseAbs().maxCoeff();
  if (!std::isfinite(change) || change <= 0.0) return step;
  const double largest = point.components.cwiseAbs().maxCoeff();
  const double error = std::clamp(beside.error.maxCoeff(), 1e-3 * options_.tolerance, options_.tolerance);
  const double balanced = std::cbrt(3.0 * error * largest * largest);
  const double seen = std::max(kSeenShare / weights_.maxCoeff(), kErrorsOfAChange * error);
  const double factor = std::clamp(std::min(balanced, seen) / change, 1.0 / kMostChangeOfStep, kMostChangeOfStep);
  return std::clamp(step * factor, kLeastStep, kMostStep);
}

}  // namespace dolp::fit
