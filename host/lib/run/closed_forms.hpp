#pragma once

#include "model/direction.hpp"
#include "model/moments.hpp"
#include "model/sky_basis.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// Moments that need no evaluator: moments of a mirror, or limits at 90 degrees of moments that diverge there. With a
/// basis of a sky (null: none) also the moments with its functions. Domain: a direction whose treatment is not
/// kIntegrated.
Moments closed_form(const Surface& surface, const Direction& direction, const SlopeShape& shape,
                    const FacetOptics& index, const SkyBasis* sky);

/// Moments at exactly 90 degrees where they diverge, up to their common factor: masking none or `integral`, cauchy with
/// q <= 3/2. Their quotients are the limits theta -> 90 degrees.
///
/// Equation: with t = v / c the horizon is v = 2 x and rho c grows as c^(2q-3) times the integral of x^(4-2q) M over
/// the azimuths of vertical facets, cos(beta) = x = cos(phi), cos(2 eta) = -1; G tends to a constant.
///
/// Accuracy: 1e-12 of r_i and 2e-15 of the albedo, for r_q too (tests GrazingLimit_*).
Moments grazing_limit_moments(const FacetOptics& index, double q);

}  // namespace dolp
