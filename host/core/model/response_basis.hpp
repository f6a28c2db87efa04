// Computes moments of many refractive indices as weighted sums of a few responses. A response is a moment with a
// Chebyshev polynomial instead of the Fresnel reflectances. The weights are Chebyshev coefficients of the reflectances.
// The variable of the polynomials is 2 u - 1, where u = asinh(c / c0) / asinh(1 / c0). c is the cosine of the local
// angle of incidence. The scale c0 is chosen for each run.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "model/facet_optics.hpp"

namespace dolp {

struct ResponseWeights {
  Eigen::VectorXd absorbed;     ///< coefficients of 1 - (R_s + R_p) / 2
  Eigen::VectorXd split;        ///< coefficients of (R_s - R_p) / (2 sin^2(beta))
  double absorbed_error = 0.0;  ///< bound of the error of the truncated series, at any angle
  double split_error = 0.0;
};

class ResponseBasis {
 public:
  /// Chooses c0 and the number of responses so that moments of all `indices` take the least time. `passes`: see
  /// response_passes(). The error of an approximated reflectance is at most `tolerance` times reflectance_level(). Null
  /// if responses would save too little time, or if no index is suitable as reference().
  static std::shared_ptr<const ResponseBasis> of(const std::vector<FacetOptics>& indices, double tolerance,
                                                 std::size_t passes);

  /// The index with the lowest reflectance_level(). Kernels integrate its moments together with the responses. Moments
  /// of a similar index are these moments plus a small sum of responses, which has a small error.
  const FacetOptics& reference() const { return reference_; }
  std::size_t count() const { return count_; }
  double c0() const { return c0_; }
  /// Distance from the cosines [0, 1] to the nearest complex cosine c where asinh(c / c0) or a reflectance is singular.
  double bend() const { return bend_; }
  const ResponseWeights& reference_weights() const { return reference_weights_; }
  /// Weights for moments of `index`; nullopt if it needs more than count() responses, as with total reflection.
  std::optional<ResponseWeights> find_weights(const FacetOptics& index) const;

 private:
  ResponseBasis(double c0, std::size_t count, std::size_t samples, double tolerance);

  FacetOptics reference_;
  ResponseWeights reference_weights_;
  std::size_t count_;
  double c0_;
  double bend_;
  double tolerance_;
  std::vector<double> cosines_;   ///< at which a reflectance curve is sampled
  Eigen::MatrixXd coefficients_;  ///< converts the samples to Chebyshev coefficients
};

inline constexpr std::size_t kMostResponses = 24;  ///< most responses that the kernels can compute at once

}  // namespace dolp
