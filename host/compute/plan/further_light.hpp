#pragma once

#include <complex>
#include <vector>

#include "model/choices.hpp"
#include "model/facet_optics.hpp"
#include "model/scattering.hpp"
#include "model/slopes.hpp"

namespace dolp {

/// Reflection by a facet at any angle. For a facet under films, a few angles are known, with linear interpolation.
class GrooveFacet {
 public:
  explicit GrooveFacet(const FacetOptics& optics);

  /// Mueller matrix in the frame of the facet: m00 = m11, m01 = m10, m22 = m33 = Re(cross), m23 = -m32 = Im(cross).
  struct Matrix {
    double m00 = 0.0;
    double m01 = 0.0;
    std::complex<double> cross;  ///< conj(r_s) r_p, with the sign of r_p for which r_p = r_s at normal incidence
  };
  /// `cosine`: of the angle of incidence, in (0, 1].
  Matrix at(double cosine) const;

 private:
  FacetOptics optics_;
  std::vector<Matrix> known_;  ///< under films: at the cosines (i / intervals)^2
};

/// Estimates what V-grooves with facets of this slope distribution reflect after the first bounce.
/// Equation: shaders/physics/README.md, section 3 (all bounces), for the bounces k >= 2. The rays have four slopes on
/// each side of 30 degrees, and four azimuths on each smooth arc.
/// Domain: theta in [0, 90] degrees, of which values above 89.9 count as 89.9; sigma > 0. For measured reflectances,
/// whose phase is unknown, the facets depolarise the component U.
/// Accuracy: 10 % of i for most surfaces; 40 % beyond 80 degrees if the slopes have a heavy tail (tests
/// FurtherLight_*).
FurtherLight further_light(Distribution distribution, double theta_deg, const SlopeShape& shape,
                           const GrooveFacet& facet);

}  // namespace dolp
