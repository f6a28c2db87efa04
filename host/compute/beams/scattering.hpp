#pragma once

#include <vector>

#include <dolp/errors.hpp>
#include "model/scattering.hpp"

namespace dolp {

/// Computes the pBRDF at pairs of directions, in double and on all cores. The evaluators vulkan
/// and cpu use it, because a beam is a product of a few numbers, and a float would lose digits of its geometry.
/// Equation: shaders/physics/README.md, sections 1 and 2 (eqs. 4, 7 and 15).
/// Accuracy: ScatteringMatrix::error (tests ScatteringOf.*).
/// Errors: InputError if an entry is outside the lists of the request; Cancelled if `progress` returns false.
std::vector<ScatteringMatrix> scattering_matrices(const ScatteringRequest& request, const Progress& progress);

}  // namespace dolp
