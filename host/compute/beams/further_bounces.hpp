#pragma once

#include "model/scattering.hpp"

namespace dolp {

/// Adds the light after two and more bounces to `f`, the pBRDF of the first bounce times cos(theta_i) cos(theta_r).
/// Returns the number of computed bounces, a measure of the time. Equation: shaders/physics/README.md, section 3.
/// Domain: masking v-cavity. In the mirror direction, grooves of all azimuths contribute, and the result is NaN.
/// Accuracy: relative error ScatteringRequest::accuracy of the sum. If a strong reflector needs more than
/// 1,000 bounces, f.error includes a bound of the light that they may add.
int add_further_bounces(ScatteringMatrix& f, const ScatteringRequest& request, const ScatteringEntry& entry);

}  // namespace dolp
