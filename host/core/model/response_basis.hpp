// Combines the moments of many indices from one index and responses to the local angle of incidence.
//
// The moments of single scattering are linear in the Fresnel reflectances along the cosine c of the local angle of
// incidence. A response is a moment with a Chebyshev polynomial of u = asinh(c / c0) / asinh(1 / c0) instead of the
// reflectances: the coefficients of an index's curves times the responses are its moments, at every direction, slope
// distribution and masking, and the coefficients left out bound the error.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "model/facet_optics.hpp"

namespace dolp {

/// Chebyshev coefficients of the curves of an index.
struct ResponseWeights {
  Eigen::VectorXd absorbed;     ///< coefficients of 1 - (R_s + R_p) / 2
  Eigen::VectorXd split;        ///< coefficients of (R_s - R_p) / (2 sin^2)
  double absorbed_error = 0.0;  ///< bound of the distance from the curve, at any angle
  double split_error = 0.0;
};

/// The responses of a run from which its indices are combined.
class ResponseBasis {
 public:
  /// Errors of the combined curves stay below the tolerance, relative to the reflectance or to the absorptance at
  /// normal incidence, whichever is less. `passes`: kernel passes with responses. Null where they cost more than
  /// integrating each index.
  static std::shared_ptr<const ResponseBasis> of(const std::vector<FacetOptics>& indices, double tolerance,
                                                 std::size_t passes);

  /// The index integrated along with the responses: sums relative to it have less noise. It has the smallest
  /// reflectance or absorptance.
  const FacetOptics& reference() const { return reference_; }
  std::size_t count() const { return count_; }
  double c0() const { return c0_; }
  /// Distance of the nearest singularity of the polynomials and the curves from the cosines of angles.
  double bend() const { return bend_; }
  const ResponseWeights& of_reference() const { return of_reference_; }
  /// None for an index whose curves need more responses, for example with total reflection. Depends only on the basis
  /// and the index.
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

/// Most responses of a basis: the most columns that kernels take.
inline constexpr std::size_t kMostResponses = 24;

}  // namespace dolp
