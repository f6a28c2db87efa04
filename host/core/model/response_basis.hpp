// Computes the moments of many indices from the moments of one index and from responses.
// The moments of single scattering are linear in the Fresnel reflectances as functions of c, the cosine of the local
// angle of incidence. A response is a moment with a Chebyshev polynomial of 2 u - 1, u = asinh(c / c0) / asinh(1 / c0),
// instead of the reflectances. The moments of an index are weighted sums of responses. The weights are the Chebyshev
// coefficients of its reflectances, for every direction, slope distribution and masking.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "model/facet_optics.hpp"

namespace dolp {

struct ResponseWeights {
  Eigen::VectorXd absorbed;     ///< coefficients of 1 - (R_s + R_p) / 2
  Eigen::VectorXd split;        ///< coefficients of (R_s - R_p) / (2 sin^2)
  double absorbed_error = 0.0;  ///< bound of the error of the truncated series, at any angle
  double split_error = 0.0;
};

class ResponseBasis {
 public:
  /// The reflectances of an index, as sums of polynomials, have errors below `tolerance` times its reflectance_level.
  /// `passes`: kernel passes that compute responses. Null if they would take longer than integrating each index.
  static std::shared_ptr<const ResponseBasis> of(const std::vector<FacetOptics>& indices, double tolerance,
                                                 std::size_t passes);

  /// The index that a kernel pass integrates besides the responses: the one with the lowest reflectance_level. Another
  /// index may have the moments of this index plus a sum over responses, which is smaller and has less error.
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
