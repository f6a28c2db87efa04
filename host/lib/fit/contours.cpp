#include "fit/contours.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>

#include "fit/descent.hpp"
#include "fit/residuals.hpp"
#include "fit/together.hpp"

namespace dolp::fit {
namespace {

constexpr std::size_t kValues = 21;         // of each parameter
constexpr double kWider = 1.4;              // than the 95 % interval of one parameter, which is 0.8 of that of two
constexpr double kFirstWidth = 2e-3;        // from the bottom of a valley to its side, in coordinates
constexpr int kMostDoublings = 10;          // of it
constexpr double kSide = 7.0;               // growth at a side: above the highest contour
constexpr double kLeastContourGain = 1e-3;  // of the scale: far below what a contour shows

double share_of(std::size_t value) { return static_cast<double>(value) / static_cast<double>(kValues - 1); }

std::optional<std::array<std::size_t, 2>> most_correlated(const Eigen::MatrixXd& correlation) {
  std::optional<std::array<std::size_t, 2>> found;
  double largest = -1.0;  // NaN is not larger
  for (Eigen::Index i = 0; i < correlation.rows(); ++i) {
    for (Eigen::Index j = i + 1; j < correlation.cols(); ++j) {
      if (!(std::abs(correlation(i, j)) > largest)) continue;
      largest = std::abs(correlation(i, j));
      found = {static_cast<std::size_t>(i), static_cast<std::size_t>(j)};
    }
  }
  return found;
}

double coordinate_of(const FitRange& parameter, const FitParameter& fitted) {
  return parameter.coordinate(fitted.value);
}

/// Coordinates around a parameter's value; an interval without an end goes to that of the range.
std::vector<double> coordinates_around(const FitRange& parameter, const FitParameter& fitted) {
  const double middle = coordinate_of(parameter, fitted);
  const auto end = [&](const std::optional<double>& value, double of_range) {
    return value ? std::clamp(middle + kWider * (parameter.coordinate(*value) - middle), 0.0, 1.0) : of_range;
  };
  const double low = end(fitted.interval_95.low, 0.0);
  const double high = end(fitted.interval_95.high, 1.0);
  std::vector<double> coordinates;
  for (std::size_t i = 0; i < kValues; ++i) coordinates.push_back(std::lerp(low, high, share_of(i)));
  return coordinates;
}

class Map {
 public:
  Map(const Model& model, MomentsEvaluator& evaluator, const FitResult& result, const FitOptions& options,
      const std::array<std::size_t, 2>& pair)
      : parameters_(model.parameters()),
        result_(result),
        pair_(pair),
        residuals_(model, result.tolerance, Differences::kForward, evaluator, options.progress) {
    Eigen::VectorXd best(static_cast<Eigen::Index>(parameters_.size()));
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      best[static_cast<Eigen::Index>(j)] = coordinate_of(parameters_[j], result.parameters[j]);
    }
    minimum_ = residuals_.linearised(best);
    descent_.loss = options.loss;
    descent_.scale = result.scale;
    descent_.least_gain = kLeastContourGain;
  }

  Contours contours() {
    const auto [one, other] = pair_;
    const std::vector<double> first = coordinates_around(parameters_[one], result_.parameters[one]);
    std::vector<std::array<double, 2>> rows(kValues);  // from where to where along the second
    run_together(residuals_, kValues,
                 [&](Residuals& own, std::size_t i) { rows[i] = across_the_valley(own, first[i]); });
    Contours contours;
    contours.parameters = pair_;
    for (const double coordinate : first) contours.first.push_back(parameters_[one].at(coordinate));
    contours.second.resize(kValues, kValues);
    contours.growth.resize(kValues, kValues);
    run_together(residuals_, kValues * kValues, [&](Residuals& own, std::size_t i) {
      const std::size_t row = i / kValues, column = i % kValues;
      const double second = std::lerp(rows[row][0], rows[row][1], share_of(column));
      const auto to = [&](Eigen::MatrixXd& values) -> double& {
        return values(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
      };
      to(contours.second) = parameters_[other].at(second);
      to(contours.growth) = growth(own, {first[row], second});
    });
    return contours;
  }

 private:
  /// The range of the second coordinate at one of the first: from the bottom of the valley up its sides.
  std::array<double, 2> across_the_valley(Residuals& own, double first) {
    const auto other = static_cast<Eigen::Index>(pair_[1]);
    DescentOptions descent = descent_;
    descent.held = {pair_[0]};
    const double bottom = descend(own, start_at({{pair_[0], first}}), descent).where.at[other];
    const double least = growth(own, {first, bottom});
    std::array<double, 2> ends{};
    for (std::size_t i = 0; i < 2; ++i) {
      const double sign = i == 0 ? -1.0 : 1.0;
      double width = kFirstWidth;
      double end = bottom;
      for (int doubling = 0; doubling < kMostDoublings; ++doubling, width *= 2.0) {
        end = std::clamp(bottom + sign * width, 0.0, 1.0);
        if (end == 0.0 || end == 1.0 || !(growth(own, {first, end}) < least + kSide)) break;
      }
      ends[i] = end;
    }
    return ends;
  }

  /// Growth of the objective at two coordinates, least over the others.
  double growth(Residuals& own, const std::array<double, 2>& coordinates) const {
    DescentOptions descent = descent_;
    descent.held = {pair_[0], pair_[1]};
    const Linearisation start = start_at({{pair_[0], coordinates[0]}, {pair_[1], coordinates[1]}});
    const double objective = descend(own, start, descent).objective;
    return std::isfinite(objective) ? (objective - result_.chi_square) / result_.scale : std::nan("");
  }

  /// Starts the other parameters on the bottom of the valley, as the derivatives at the minimum predict it.
  Linearisation start_at(const std::vector<std::pair<std::size_t, double>>& held) const {
    Linearisation start;
    start.at = minimum_.at;
    Eigen::MatrixXd others = minimum_.jacobian;
    Eigen::VectorXd change = Eigen::VectorXd::Zero(minimum_.residuals.size());
    for (const auto& [parameter, coordinate] : held) {
      const auto column = static_cast<Eigen::Index>(parameter);
      change += minimum_.jacobian.col(column) * (coordinate - minimum_.at[column]);
      others.col(column).setZero();
      start.at[column] = coordinate;
    }
    start.at -= others.completeOrthogonalDecomposition().solve(change);
    start.at = start.at.cwiseMax(0.0).cwiseMin(1.0);
    return start;
  }

  const std::vector<FitRange>& parameters_;
  const FitResult& result_;
  std::array<std::size_t, 2> pair_;
  Residuals residuals_;
  Linearisation minimum_;
  DescentOptions descent_;
};

}  // namespace

std::optional<Contours> contours_of(const Model& model, MomentsEvaluator& evaluator, const FitResult& result,
                                    const FitOptions& options) {
  const auto pair = most_correlated(result.correlation);
  if (!pair) return std::nullopt;
  return Map(model, evaluator, result, options, *pair).contours();
}

}  // namespace dolp::fit
