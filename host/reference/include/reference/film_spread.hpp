#pragma once

#include <utility>
#include <vector>

#include "model/facet_optics.hpp"
#include "reference/fresnel.hpp"

namespace dolp::reference {

bool has_spread(const FacetOptics& optics);

/// The stack at single thicknesses of its films, for light with this angle of incidence, with weights whose sum is 1. A
/// mean over the normal distributions of the thicknesses is the weighted sum of values at these stacks. Equation:
/// Gauss-Legendre panels, at least six for each fringe, between 8 spreads below (but not below 0) and above.
std::vector<std::pair<FacetOptics, double>> single_stacks(const FacetOptics& optics, double cos_beta);

/// Mean reflectances and absorptances of a stack whose films vary. The amplitudes are the roots of the reflectances.
/// Interpolated in sqrt(cos(beta)) between means that are kept for the next call.
FresnelCoefficients mean_coefficients(const FacetOptics& optics, double cos_beta);

}  // namespace dolp::reference
