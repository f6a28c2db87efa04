// Emission of the facets that goes straight to the viewer.
#pragma once

#include <functional>

#include "model/moments.hpp"
#include "reference/hemisphere.hpp"
#include "reference/slopes.hpp"

namespace dolp::reference {

/// The direct emission of a rough surface (sigma > 0): direct_i, direct_q and their errors. All other members are 0.
///
/// Equation: cos(theta) eps = int P t dt dphi e G_1 (1 - |r|^2) in the view's frame, e = cos(theta) + sin(theta) t
///   cos(phi), over all facets with e > 0, G_1 being the masking of the view.
/// Domain: masking smith or v-cavity; theta in [0, 90] degrees; at 90 both are 0, the limit.
/// Accuracy: the tolerance of `refinement`, relative to direct_i.
Moments direct_emission(const Slopes& slopes, Masking masking, double theta_deg, const FacetOptics& constants,
                        const Refinement& refinement);

/// The direct emission with a curve instead of 1 - (R_s + R_p) / 2 and (R_p - R_s) / (2 sin^2). The accuracy is
/// relative to cos(theta). `bend` is the cosine at which the curve bends.
Moments direct_response(const Slopes& slopes, Masking masking, double theta_deg,
                        const std::function<double(double cos_beta)>& curve, double bend, const Refinement& refinement);

}  // namespace dolp::reference
