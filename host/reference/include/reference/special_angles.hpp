// Angles at which the Fresnel coefficients bend.
#pragma once

#include <cmath>
#include <cstdint>

#include "model/facet_optics.hpp"

namespace dolp::reference {

/// The angles beta of total reflection and of the (pseudo-)Brewster minimum.
class SpecialAngles {
 public:
  explicit SpecialAngles(const FacetOptics& constants)
      : brewster_(1.0 / std::hypot(1.0, constants.index.n, constants.index.k)),
        critical_(constants.index.n < 1.0 ? std::sqrt(1.0 - constants.index.n * constants.index.n) : 0.0) {}

  /// Code of the angles that cos(beta) is beyond: 0 to 3.
  std::uint64_t side(double cos_beta) const {
    return (cos_beta < brewster_ ? 1U : 0U) + (cos_beta < critical_ ? 2U : 0U);
  }

 private:
  double brewster_;
  double critical_;
};

}  // namespace dolp::reference
