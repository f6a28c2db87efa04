// Computes moments of many refractive indices as weighted sums of a few responses. A response is a moment with a
// Chebyshev polynomial of 2 u - 1 instead of the Fresnel reflectances, where u = asinh(c / c0) / asinh(1 / c0) with a
// scale c0 and the cosine c of the local incidence. The weights are Chebyshev coefficients of the reflectances.
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
  /// Approximates the reflectances of each index to `tolerance` times its reflectance_level. `passes`: number of kernel
  /// passes that compute responses. Null if responses would save too little time.
  static std::shared_ptr<const ResponseBasis> of(const std::vector<FacetOptics>& indices, double tolerance,
                                                 std::size_t passes);

  /// The index with the lowest reflectance_level. Kernels integrate its moments besides the responses. Moments of
  /// another index can then be the moments of the reference plus a small sum over responses, which has a small error.
  const FacetOptics& reference() const { return reference_; }
  std::size_t count() const { return count_; }
  double c0() const { return c0_; }
  /// Distance from the cosines [0, 1] to the nearest complex cosine at which u or a reflectance is singular.
  double bend() const { return bend_; }
  const ResponseWeights& of_reference() const { return of_reference_; }
  /// Weights for moments of `index`; nullopt if it needs more than count() responses, as with total reflection.
  std::optional<ResponseWeights> weights_of(const FacetOptics& index) const;

 private:
  ResponseBasis() = default;

  FacetOptics reference_;
  ResponseWeights of_reference_;
  std::size_t count_ = 0;
  double c0_ = 1.0;
  double bend_ = 1.0;
  double tolerance_ = 0.0;
};

inline constexpr std::size_t kMostResponses = 24;  ///< most responses that the kernels can compute at once

}  // namespace dolp
