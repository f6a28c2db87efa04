#pragma once

#include "model/direction.hpp"
#include "model/moments.hpp"
#include "model/sky_basis.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// Moments of a mirror, or limits of moments that diverge at 90 degrees. If `sky` is not null, also the moments with
/// its functions of the zenith. Domain: a direction whose treatment is not kIntegrated.
Moments closed_form(const Surface& surface, const Direction& direction, const SlopeShape& shape,
                    const FacetOptics& index, const SkyBasis* sky);

/// Moments at exactly 90 degrees where they diverge: with masking none or `integral`, and the cauchy distribution with
/// q <= 3/2. The divergent factor, which is common to all, is left out. So quotients of moments are limits theta -> 90
/// degrees.
/// Equation: let c = cos(theta), and v / c the slope of a facet with azimuth phi, x = cos(phi). At grazing incidence a
/// reflected ray leaves the surface if v < 2 x, and the masking G tends to a constant. So rho c grows as c^(2q-3) times
/// the integral over phi of x^(4-2q) R for vertical facets, with cos(beta) = x. R is (R_s + R_p) / 2 for r_i and (R_p -
/// R_s) / 2 for r_q. Accuracy: the errors of r_i and r_q are at most 1e-12 r_i + 2e-15 albedo (tests GrazingLimit_*).
Moments grazing_limit_moments(const FacetOptics& index, double q);

}  // namespace dolp
