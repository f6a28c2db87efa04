#pragma once

#include "model/direction.hpp"
#include "model/moments.hpp"
#include "model/sky_basis.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// The moments of a mirror, or limits of moments that diverge at 90 degrees. With `sky`, also the moments weighted with
/// the functions of the sky. Domain: a direction whose treatment is not kIntegrated.
Moments closed_form(const Surface& surface, const Direction& direction, const SlopeShape& shape,
                    const FacetOptics& index, const SkyBasis* sky);

/// Moments at exactly 90 degrees for masking `none` or `integral` and the cauchy distribution with q <= 3/2. The true
/// moments are infinite there, but their quotients have limits. The returned moments are finite and have these
/// quotients. Equation: x = cos(phi) is the cosine of the angle of incidence on a vertical facet with the azimuth phi.
/// A moment is the integral of x^(4-2q) R over phi from 0 to pi/2. R is (R_s + R_p) / 2 for r_i, (R_p - R_s) / 2 for
/// r_q, 1 for albedo. Accuracy: the errors of r_i and r_q are at most 1e-12 r_i + 2e-15 albedo (tests GrazingLimit_*).
Moments grazing_limit_moments(const FacetOptics& index, double q);

}  // namespace dolp
