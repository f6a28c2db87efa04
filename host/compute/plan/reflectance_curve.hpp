// Tables from which the kernel reads the reflectances of facets that have no formula there: films, measurements.
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "model/facet_optics.hpp"

namespace dolp {

/// Cubics over sqrt(cos(beta)) in cells of one width. Each cell takes DOLP_CURVE_NODES rule nodes
/// (physics/fresnel.glsl).
struct ReflectanceCurve {
  std::vector<std::array<double, 2>> nodes;
  std::size_t cells = 0;
  double error = 0.0;      ///< bound of the distance of R_s, 1 - R_s and (R_s - R_p) / 2 from the cubics
  double steepness = 0.0;  ///< largest change of these with the logarithm of sqrt(cos(beta)), which rounding multiplies
  /// The pole in cos(beta) that would make R_s or R_p as steep as it is where it is steepest.
  std::complex<double> pole;
};

/// Takes as many cells as bring the error to a share of the tolerance, up to a limit. The tolerance is relative to the
/// reflectance or the absorptance at normal incidence, whichever is less. Domain: optics that are not bare.
ReflectanceCurve reflectance_curve(const FacetOptics& optics, double tolerance);

}  // namespace dolp
