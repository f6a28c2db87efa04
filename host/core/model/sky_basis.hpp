// Functions of the zenith that describe a sky, and a basis: a few functions whose sums give the sky at all wavelengths.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

namespace dolp {

/// Finds the weighted sum of some columns that is nearest to given values. Method: orthonormal columns by Gram and
/// Schmidt. A second pass keeps them orthogonal to rounding.
class LeastSquares {
 public:
  LeastSquares() = default;
  /// Domain: the columns are linearly independent.
  explicit LeastSquares(const Eigen::MatrixXd& columns);

  /// The weight of each column in the sum that is nearest to `values`. Rows that `values` lacks count as 0.
  Eigen::VectorXd solve(const Eigen::VectorXd& values) const;

 private:
  // The columns are orthonormal_ * triangle_.
  Eigen::MatrixXd orthonormal_;
  Eigen::MatrixXd triangle_;
};

/// Zeniths at which functions of a sky are tabulated. The zeniths from 0 to 90 are split into parts at `ends_deg`,
/// where the functions may have corners. Within a part a function is the polynomial through its values at
/// Chebyshev-Lobatto points.
class SkyNodes {
 public:
  /// `ends_deg`: the ends of the parts, ascending from 0 to 90, at least three.
  explicit SkyNodes(std::vector<double> ends_deg);

  const std::vector<double>& ends_deg() const { return ends_deg_; }
  const std::vector<double>& zenith_deg() const { return zenith_deg_; }

  /// The values of functions at a zenith, from their values at the nodes. Shape: `values` are nodes x functions.
  Eigen::RowVectorXd at(double zenith_deg, const Eigen::MatrixXd& values) const;

  /// Estimate of the largest distance between a function and the polynomials through its values at the nodes.
  double error(const Eigen::VectorXd& values) const;

  /// Weights with which a function's values at the nodes add up to its mean over the sky. In this mean a zenith counts
  /// with cos^(power + 1) sin, times `factor` of the cosine if there is one. A surface receives this mean if its
  /// reflectance is proportional to cos^power times the factor.
  /// Domain: power > -1.
  Eigen::VectorXd mean_weights(double power, const std::function<double(double)>& factor = {}) const;

 private:
  std::vector<double> ends_deg_;
  std::vector<double> points_;  ///< Chebyshev-Lobatto points on [-1, 1], the same for each part
  std::vector<double> zenith_deg_;
};

/// A function of the zenith as a weighted sum of the functions of a basis.
struct SkyWeights {
  Eigen::VectorXd of;  ///< weight of each function of the basis
  double error = 0.0;  ///< bound of the distance between function and sum, at any zenith
};

/// A few functions of the zenith with absolute values up to 1. The moments with these functions give the moments with
/// every weighted sum of them.
class SkyBasis {
 public:
  /// Chooses some of `functions`, given by their values at the nodes. Adds the worst represented one until weighted
  /// sums of the chosen ones represent each function to `tolerance` of its largest value, or until kMostSkyFunctions
  /// are chosen.
  SkyBasis(SkyNodes nodes, const std::vector<Eigen::VectorXd>& functions, double tolerance);

  const SkyNodes& nodes() const { return nodes_; }
  std::size_t size() const { return static_cast<std::size_t>(values_.cols()); }
  /// The values of the functions of the basis at a zenith.
  Eigen::RowVectorXd at(double zenith_deg) const { return nodes_.at(zenith_deg, values_); }
  SkyWeights weights_of(const Eigen::VectorXd& function) const;
  /// A basis with only one function of this basis.
  SkyBasis only(std::size_t function) const {
    return {nodes_, {values_.col(static_cast<Eigen::Index>(function))}, 0.0};
  }

 private:
  SkyNodes nodes_;
  Eigen::MatrixXd values_;  ///< nodes x functions
  LeastSquares sums_;       ///< finds weighted sums of these functions
};

/// Most functions of a basis. Kernels take no more.
inline constexpr std::size_t kMostSkyFunctions = 8;

}  // namespace dolp
