#pragma once

#include <array>
#include <complex>
#include <vector>

#include "model/facet_optics.hpp"

namespace dolp {

/// Cubics over sqrt(cos(beta)), in cells of equal width with DOLP_CURVE_NODES rule nodes each (physics/fresnel.glsl).
struct ReflectanceCurve {
  std::vector<std::array<double, 2>> nodes;
  std::size_t cells = 0;
  double error = 0.0;      ///< bound of the distance of R_s, 1 - R_s and (R_s - R_p) / 2 from the cubics
  double steepness = 0.0;  ///< largest derivative of these three with respect to ln sqrt(cos(beta))
  /// The pole in cos(beta) that gives R_s or R_p its largest steepness.
  std::complex<double> pole;
};

/// The curve has as many cells as a share of the tolerance needs, up to a limit. The tolerance is relative to the
/// smaller of reflectance and absorptance at normal incidence. Domain: optics that are not bare.
ReflectanceCurve reflectance_curve(const FacetOptics& optics, double tolerance);

}  // namespace dolp
