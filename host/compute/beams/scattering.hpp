#pragma once

#include <vector>

#include <dolp/errors.hpp>
#include "model/scattering.hpp"

namespace dolp {

/// Computes the pBRDF at pairs of directions, in double and on all cores. The evaluators vulkan and cpu use it, because
/// a beam is a product of a few numbers, and a float would lose digits of its geometry.
/// Equation: shaders/physics/README.md, sections 1 and 2 (eqs. 4, 7 and 15).
/// Accuracy: ScatteringMatrix::error (tests ScatteringOf.*).
/// Errors: InputError if an entry is outside the lists of the request; Cancelled if `progress` returns false.
std::vector<ScatteringMatrix> scattering_matrices(const ScatteringRequest& request, const Progress& progress);

/// Adds the light after two and more bounces to `f`, the pBRDF of the first bounce times cos(theta_i) cos(theta_r).
/// Returns the number of computed bounces, a measure of the time. Equation: shaders/physics/README.md, section 3.
/// Domain: masking v-cavity. In the mirror direction, grooves of all azimuths contribute, and the result is NaN.
/// Accuracy: relative error ScatteringRequest::accuracy of the sum. If a strong reflector needs more than
/// 1,000 bounces, f.error includes a bound of the light that they may add.
int add_further_bounces(ScatteringMatrix& f, const ScatteringRequest& request, const ScatteringEntry& entry);

}  // namespace dolp
