// Functions of the zenith that describe a sky, and a basis of a few functions for all wavelengths.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

namespace dolp {

/// Finds sums of columns that are nearest to given values. Method: Gram and Schmidt's orthonormal columns, twice, which
/// keeps them orthogonal to rounding.
class LeastSquares {
 public:
  LeastSquares() = default;
  /// `columns` are linearly independent.
  explicit LeastSquares(const Eigen::MatrixXd& columns);

  /// The weight of each column in the sum that is nearest to `values`, and to 0 in the rows below.
  Eigen::VectorXd solve(const Eigen::VectorXd& values) const;

 private:
  // Their product is the columns.
  Eigen::MatrixXd orthonormal_;
  Eigen::MatrixXd triangle_;
};

/// Zeniths at which functions of a sky are known: between two ends, which may be corners, they are the polynomial
/// through Chebyshev-Lobatto points.
class SkyNodes {
 public:
  /// `ends_deg`: ascending from 0 to 90, with one at least between.
  explicit SkyNodes(std::vector<double> ends_deg);

  const std::vector<double>& ends_deg() const { return ends_deg_; }
  const std::vector<double>& zenith_deg() const { return zenith_deg_; }

  /// The values of functions at a zenith. Shape: `values` are nodes x functions.
  Eigen::RowVectorXd at(double zenith_deg, const Eigen::MatrixXd& values) const;

  /// Estimate of the largest distance between the polynomials through a function's values and the function.
  double error(const Eigen::VectorXd& values) const;

  /// Weights of the values in the mean of a function, the integral over the zenith with cos^(power + 1) sin, times
  /// `factor` of the cosine if there is one: what a reflectance proportional to cos^power times the factor sees of it.
  /// Domain: power > -1.
  Eigen::VectorXd mean_weights(double power, const std::function<double(double)>& factor = {}) const;

 private:
  std::vector<double> ends_deg_;
  std::vector<double> points_;  ///< points of a part, on [-1, 1]
  std::vector<double> zenith_deg_;
};

/// A function of a sky as a sum over a basis.
struct SkyWeights {
  Eigen::VectorXd of;  ///< for each function of the basis
  double error = 0.0;  ///< bound of the distance from the sum, at any zenith
};

/// Functions of the zenith with absolute values up to 1. The moments of a surface with these serve all functions that
/// are sums of them.
class SkyBasis {
 public:
  /// The fewest of `functions`, as columns of values at the nodes, from which sums represent the others to `tolerance`
  /// of their largest value; at most kMostSkyFunctions.
  SkyBasis(SkyNodes nodes, const std::vector<Eigen::VectorXd>& functions, double tolerance);

  const SkyNodes& nodes() const { return nodes_; }
  std::size_t size() const { return static_cast<std::size_t>(values_.cols()); }
  /// The functions at a zenith.
  Eigen::RowVectorXd at(double zenith_deg) const { return nodes_.at(zenith_deg, values_); }
  SkyWeights weights_of(const Eigen::VectorXd& function) const;
  /// A basis of one function.
  SkyBasis only(std::size_t function) const {
    return {nodes_, {values_.col(static_cast<Eigen::Index>(function))}, 0.0};
  }

 private:
  SkyNodes nodes_;
  Eigen::MatrixXd values_;  ///< nodes x functions
  LeastSquares sums_;       ///< sums of these functions
};

/// Most functions of a basis: the most that kernels take.
inline constexpr std::size_t kMostSkyFunctions = 8;

}  // namespace dolp
