#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

namespace dolp {

/// Finds the weighted sum of columns that is nearest to given values, by Gram-Schmidt orthogonalization.
class LeastSquares {
 public:
  LeastSquares() = default;
  /// Domain: the columns are linearly independent.
  explicit LeastSquares(const Eigen::MatrixXd& columns);

  /// The weight of each column in the sum that is nearest to `values`. Rows beyond the end of `values` count as 0.
  Eigen::VectorXd solve(const Eigen::VectorXd& values) const;

 private:
  Eigen::MatrixXd orthonormal_;
  Eigen::MatrixXd triangle_;  ///< the columns are orthonormal_ * triangle_
};

/// Zeniths at which functions of the zenith are tabulated. `ends_deg` divides [0, 90] into parts; a function may have
/// kinks at these ends. In each part it is the polynomial through its values at Chebyshev-Lobatto points.
class SkyNodes {
 public:
  /// `ends_deg`: at least three values, ascending from 0 to 90.
  explicit SkyNodes(std::vector<double> ends_deg);

  const std::vector<double>& ends_deg() const { return ends_deg_; }
  const std::vector<double>& zenith_deg() const { return zenith_deg_; }

  /// Interpolates functions to `zenith_deg`. `values`: the functions at the nodes. Shape: nodes x functions.
  Eigen::RowVectorXd at(double zenith_deg, const Eigen::MatrixXd& values) const;

  /// Estimate of the largest distance between a function and the polynomials through `values`, its values at the nodes.
  double error(const Eigen::VectorXd& values) const;

  /// Weights for a function's values at the nodes. The weighted sum is the mean over the sky that a surface receives if
  /// its reflectance is proportional to cos^power times `factor` of the cosine of the zenith. Domain: power > -1.
  Eigen::VectorXd mean_weights(double power, const std::function<double(double)>& factor = {}) const;

 private:
  std::vector<double> ends_deg_;
  std::vector<double> points_;  ///< Chebyshev-Lobatto points on [-1, 1], the same for each part
  std::vector<double> zenith_deg_;
};

/// Approximates a function of the zenith by a weighted sum of the functions of a SkyBasis.
struct SkyWeights {
  Eigen::VectorXd of;  ///< weight of each function of the basis
  double error = 0.0;  ///< bound of the distance between the function and the sum, at any zenith
};

/// A few functions of the zenith with absolute values up to 1. Their weighted sums give a sky at each wavelength.
class SkyBasis {
 public:
  /// Chooses some of `functions`, given at the nodes: always the one with the largest error, until weighted sums
  /// approximate each function to `tolerance` of its largest value, or until kMostSkyFunctions are chosen.
  SkyBasis(SkyNodes nodes, const std::vector<Eigen::VectorXd>& functions, double tolerance);

  const SkyNodes& nodes() const { return nodes_; }
  std::size_t size() const { return static_cast<std::size_t>(values_.cols()); }
  Eigen::RowVectorXd at(double zenith_deg) const { return nodes_.at(zenith_deg, values_); }
  SkyWeights weights_of(const Eigen::VectorXd& function) const;
  SkyBasis only(std::size_t function) const {
    return {nodes_, {values_.col(static_cast<Eigen::Index>(function))}, 0.0};
  }

 private:
  SkyNodes nodes_;
  Eigen::MatrixXd values_;  ///< nodes x functions
  LeastSquares sums_;
};

inline constexpr std::size_t kMostSkyFunctions = 8;  ///< most functions of a sky that the kernels accept

}  // namespace dolp
