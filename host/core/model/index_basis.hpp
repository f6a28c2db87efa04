// The moments of many indices from those of a few.
//
// The moments of single scattering are linear in the Fresnel reflectances along the cosine of the local angle of
// incidence, and these curves, of all indices of a table, lie in a space of few dimensions. Weights that combine the
// curves of a few indices to that of another combine their moments too, at every direction, slope distribution and
// masking, and the largest distance between the curves bounds the error.
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "model/least_squares.hpp"
#include "model/optical_constants.hpp"

namespace dolp {

/// Weights that combine the moments of an index from those of a basis.
struct IndexWeights {
  Eigen::VectorXd mean;        ///< for each basis index, for moments from (R_s + R_p) / 2; their sum is 1
  Eigen::VectorXd difference;  ///< for moments from (R_s - R_p) / 2
  double mean_error = 0.0;     ///< bound of the distance from the combined (R_s + R_p) / 2, at any angle
  double difference_error = 0.0;
};

/// Some of the indices of a run, from which the others are combined.
class IndexBasis {
 public:
  /// Errors of the combined curves stay below the tolerance, relative to the reflectance or to the absorptance at
  /// normal incidence, whichever is less. Null where the basis is more than half of the indices.
  static std::shared_ptr<const IndexBasis> of(const std::vector<OpticalConstants>& indices, double tolerance);

  const std::vector<OpticalConstants>& indices() const { return indices_; }
  /// None for an index that the basis does not reach: one whose curve has a kink, as total reflection makes it, or
  /// differs from all of the basis. Follows from the basis and the index alone.
  std::optional<IndexWeights> weights_of(const OpticalConstants& index) const;

 private:
  enum Curve : std::uint8_t { kMean, kDifference };
  IndexBasis() = default;
  void prepare_weights(double tolerance);
  std::optional<IndexWeights> computed_weights(const OpticalConstants& index) const;

  std::vector<OpticalConstants> indices_;
  std::array<Eigen::VectorXd, 2> first_;   ///< the curve of the first
  std::array<Eigen::MatrixXd, 2> curves_;  ///< of each other its distance from that
  std::array<LeastSquares, 2> others_;     ///< of these distances, and a ridge below each
  double tolerance_ = 0.0;
  std::map<std::pair<double, double>, std::optional<IndexWeights>> known_;  ///< by n and k, of the run's indices
};

}  // namespace dolp
