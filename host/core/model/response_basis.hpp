// Moments of many refractive indices as weighted sums of responses. A response is a moment in which a Chebyshev
// polynomial of 2 u - 1 replaces the Fresnel reflectances. Here u = asinh(c / c0) / asinh(1 / c0), and c is the cosine
// of the local angle of incidence. The weights are the Chebyshev coefficients of the reflectances of an index.
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
  /// passes that compute responses. Null if responses would take longer than integrating each index.
  static std::shared_ptr<const ResponseBasis> of(const std::vector<FacetOptics>& indices, double tolerance,
                                                 std::size_t passes);

  /// The index with the lowest reflectance_level. Kernels integrate it besides the responses. The moments of another
  /// index may be its moments plus a sum over responses, which is smaller and has less error.
  const FacetOptics& reference() const { return reference_; }
  std::size_t count() const { return count_; }
  double c0() const { return c0_; }
  /// Distance in the complex plane from the cosines [0, 1] to the nearest singularity of polynomials or reflectances.
  double bend() const { return bend_; }
  const ResponseWeights& of_reference() const { return of_reference_; }
  /// Nullopt if the index needs more than count() responses, for example because of total reflection.
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
