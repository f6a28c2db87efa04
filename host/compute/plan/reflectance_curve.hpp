#pragma once

#include <array>
#include <complex>
#include <vector>

#include "model/facet_optics.hpp"

namespace dolp {

/// A table of R_s, 1 - R_s and (R_s - R_p) / sin^2(beta) over sqrt(cos(beta)), in cells of equal width. Each cell has a
/// cubic for each of the three. DOLP_CURVE_NODES elements of `nodes` store the coefficients (physics/fresnel.glsl).
struct ReflectanceCurve {
  std::vector<std::array<double, 2>> nodes;
  std::size_t cells = 0;
  double error = 0.0;         ///< bound of the distance of R_s, 1 - R_s and (R_s - R_p) / 2 from the cubics
  double steepness = 0.0;     ///< largest derivative of the same quantities over ln sqrt(cos(beta))
  std::complex<double> pole;  ///< pole in cos(beta) that makes a function as steep as R_s or R_p
};

/// Doubles the number of cells until the error is at most a share of the tolerance, or the number reaches its limit.
/// The tolerance is relative to reflectance_level(). Domain: optics that are not bare.
ReflectanceCurve reflectance_curve(const FacetOptics& optics, double tolerance);

}  // namespace dolp
