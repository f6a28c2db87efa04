#pragma once

#include "model/direction.hpp"
#include "model/moments.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// Moments that need no evaluator: of a mirror, or the limits at 90 degrees of moments that diverge there.
/// Domain: a direction whose treatment is not kIntegrated.
Moments closed_form(const Surface& surface, const Direction& direction, const SlopeShape& shape,
                    const OpticalConstants& index);

}  // namespace dolp
