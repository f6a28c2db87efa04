#include "model/sky_basis.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "model/angles.hpp"
#include "model/chebyshev.hpp"

namespace dolp {
namespace {

constexpr Eigen::Index kPoints = 17;  // Chebyshev points in each interval of zeniths

// Assumed bound of the error of a sum of basis functions between nodes, as a multiple of the largest error at a node.
constexpr double kBetweenNodes = 1.5;
constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon();

// SkyNodes::error() is kBeyondLast times the sum of |a| over the last kLastCoefficients Chebyshev coefficients a.
constexpr Eigen::Index kLastCoefficients = 4;
constexpr double kBeyondLast = 2.0;

// Near the horizon mean_weights integrates over y, with cos(zenith) ~ y^4. Powers of the cosine are smooth in y.
constexpr double kHorizonPower = 4.0;

}  // namespace

SkyNodes::SkyNodes(std::vector<double> ends_deg) : ends_deg_(std::move(ends_deg)), points_(lobatto_points(kPoints)) {
  for (std::size_t i = 0; i + 1 < ends_deg_.size(); ++i) {
    for (const double point : points_)
      zenith_deg_.push_back(0.5 * ((1.0 + point) * ends_deg_[i] + (1.0 - point) * ends_deg_[i + 1]));
  }
}

Eigen::RowVectorXd SkyNodes::at(double zenith_deg, const Eigen::MatrixXd& values) const {
  const auto above = std::upper_bound(ends_deg_.begin() + 1, ends_deg_.end() - 1, zenith_deg);
  const double end = *above;
  const double start = *(above - 1);
  const double x = std::clamp((end - zenith_deg + (start - zenith_deg)) / (end - start), -1.0, 1.0);
  const Eigen::Index first = (above - ends_deg_.begin() - 1) * kPoints;
  // Like cardinal_values, but with one memory allocation: the kernels' table of a sky needs 65,000 zeniths.
  std::array<double, kPoints> weights{};
  double total = 0.0;
  for (Eigen::Index i = 0; i < kPoints; ++i) {
    const double distance = x - points_[static_cast<std::size_t>(i)];
    if (distance == 0.0) return values.row(first + i);
    const double end_factor = i == 0 || i == kPoints - 1 ? 0.5 : 1.0;
    weights[static_cast<std::size_t>(i)] = (i % 2 == 0 ? end_factor : -end_factor) / distance;
    total += weights[static_cast<std::size_t>(i)];
  }
  Eigen::RowVectorXd result(values.cols());
  for (Eigen::Index k = 0; k < result.size(); ++k) {
    const double* const column = &values(first, k);
    double sum = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * column[i];
    result[k] = sum / total;
  }
  return result;
}

double SkyNodes::error(const Eigen::VectorXd& values) const {
  static const Eigen::MatrixXd kLast = chebyshev_coefficients(kPoints).bottomRows(kLastCoefficients);
  double error = 0.0;
  for (Eigen::Index first = 0; first < values.size(); first += kPoints)
    error = std::max(error, kBeyondLast * (kLast * values.segment(first, kPoints)).cwiseAbs().sum());
  return error;
}

Eigen::VectorXd SkyNodes::mean_weights(double power) const {
  using Rule = boost::math::quadrature::gauss<double, 30>;
  const auto count = static_cast<Eigen::Index>(zenith_deg_.size());
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(count);
  for (std::size_t part = 0; part + 1 < ends_deg_.size(); ++part) {
    const double start = ends_deg_[part];
    const double end = ends_deg_[part + 1];
    const bool is_last = part + 2 == ends_deg_.size();
    const auto add = [&](double y, double weight) {  // y in [0, 1]
      double zenith_deg = start + (end - start) * y;
      CosSin at = cos_sin_deg(zenith_deg);
      double measure = at.sin * (end - start) * std::numbers::pi / 180.0;
      if (is_last) {
        const double from = cos_sin_deg(start).cos;
        at.cos = from * std::pow(y, kHorizonPower);
        zenith_deg = std::acos(at.cos) * 180.0 / std::numbers::pi;
        measure = kHorizonPower * from * std::pow(y, kHorizonPower - 1.0);
      }
      const double x = std::clamp((end - zenith_deg + (start - zenith_deg)) / (end - start), -1.0, 1.0);
      weights.segment(static_cast<Eigen::Index>(part) * kPoints, kPoints) +=
          weight * measure * std::pow(at.cos, power + 1.0) * cardinal_values(points_, x).transpose();
    };
    for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
      add(0.5 * (1.0 + Rule::abscissa()[i]), Rule::weights()[i]);
      add(0.5 * (1.0 - Rule::abscissa()[i]), Rule::weights()[i]);
    }
  }
  return weights / weights.sum();  // the mean of a constant function is the constant
}

SkyBasis::SkyBasis(SkyNodes nodes, const std::vector<Eigen::VectorXd>& functions, double tolerance)
    : nodes_(std::move(nodes)), values_(static_cast<Eigen::Index>(nodes_.zenith_deg().size()), 0) {
  while (size() < kMostSkyFunctions) {
    const Eigen::VectorXd* worst = nullptr;
    double largest = tolerance;
    for (const Eigen::VectorXd& function : functions) {
      const double scale = function.cwiseAbs().maxCoeff();
      const double error = scale > 0.0 ? find_weights(function).error / scale : 0.0;
      if (error <= largest) continue;
      largest = error;
      worst = &function;
    }
    if (!worst) break;
    values_.conservativeResize(Eigen::NoChange, values_.cols() + 1);
    values_.rightCols(1) = *worst / worst->cwiseAbs().maxCoeff();
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(values_);
    orthonormal_ = qr.householderQ() * Eigen::MatrixXd::Identity(values_.rows(), values_.cols());
    triangle_ = qr.matrixQR().topRows(values_.cols());
  }
}

SkyWeights SkyBasis::find_weights(const Eigen::VectorXd& function) const {
  if (size() == 0) return {{}, function.cwiseAbs().maxCoeff()};
  SkyWeights weights;
  weights.of = triangle_.triangularView<Eigen::Upper>().solve(orthonormal_.transpose() * function);
  const double terms = weights.of.cwiseAbs().sum();
  weights.error = kBetweenNodes * (values_ * weights.of - function).cwiseAbs().maxCoeff() + kRounding * terms;
  return weights;
}

}  // namespace dolp
