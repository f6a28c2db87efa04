#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace dolp {

/// Zeniths at which functions of the zenith are tabulated. `ends_deg` divides [0, 90] into intervals. In each interval
/// a function is the polynomial through its values at Chebyshev-Lobatto points. Between intervals it may have kinks.
class SkyNodes {
 public:
  explicit SkyNodes(std::vector<double> ends_deg);  ///< at least three values, ascending from 0 to 90

  const std::vector<double>& ends_deg() const { return ends_deg_; }
  const std::vector<double>& zenith_deg() const { return zenith_deg_; }

  /// Interpolates functions to `zenith_deg`. `values`: the functions at the nodes. Shape: nodes x functions.
  Eigen::RowVectorXd at(double zenith_deg, const Eigen::MatrixXd& values) const;

  /// Estimates the largest interpolation error of at() for one function. `values`: the function at the nodes.
  double error(const Eigen::VectorXd& values) const;

  /// A weight for each node. The weighted sum of a function's values at the nodes is its mean over the solid angle of
  /// the sky. In this mean, a direction with the cosine c of the zenith has the weight c^(power + 1): the projected
  /// area c times the reflectance c^power. Domain: power > -1.
  Eigen::VectorXd mean_weights(double power) const;

 private:
  std::vector<double> ends_deg_;
  std::vector<double> points_;  ///< Chebyshev-Lobatto points on [-1, 1], used in each interval
  std::vector<double> zenith_deg_;
};

/// Approximates a function of the zenith by a weighted sum of the functions of a SkyBasis.
struct SkyWeights {
  Eigen::VectorXd of;  ///< weight of each function of the basis
  double error = 0.0;  ///< bound of the distance between the function and the sum, at any zenith
};

/// Functions f of the zenith, |f| <= 1. Weighted sums of them approximate a sky's radiance minus its mean.
class SkyBasis {
 public:
  /// `functions`: the values of each function at the nodes. The constructor repeatedly adds to the basis the function
  /// that the basis approximates worst. It stops if each error is at most `tolerance` times the largest absolute value
  /// of the function, or if the basis has kMostSkyFunctions functions.
  SkyBasis(SkyNodes nodes, const std::vector<Eigen::VectorXd>& functions, double tolerance);

  const SkyNodes& nodes() const { return nodes_; }
  std::size_t size() const { return static_cast<std::size_t>(values_.cols()); }
  Eigen::RowVectorXd at(double zenith_deg) const { return nodes_.at(zenith_deg, values_); }
  SkyWeights find_weights(const Eigen::VectorXd& function) const;
  SkyBasis only(std::size_t function) const {
    return {nodes_, {values_.col(static_cast<Eigen::Index>(function))}, 0.0};
  }

 private:
  SkyNodes nodes_;
  Eigen::MatrixXd values_;       ///< nodes x functions
  Eigen::MatrixXd orthonormal_;  ///< values_ = orthonormal_ * triangle_
  Eigen::MatrixXd triangle_;
};

inline constexpr std::size_t kMostSkyFunctions = 8;  ///< most functions of a sky that the kernels accept

}  // namespace dolp
