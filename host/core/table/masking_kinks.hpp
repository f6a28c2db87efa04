// Zenith angles at which a bistatic beam has a kink.
#pragma once

#include <vector>

#include "scene/scene.hpp"

namespace dolp {

/// Zenith angles of the source, in degrees, at which the masking of a bistatic beam has a kink, whatever sigma and q.
///
/// Method: `integral` and V-cavities take the lower of the two directions, which changes where the source stands as
/// high as the view; V-cavities have another kink where G reaches 1 (shaders/physics/README.md, section 2).
/// Domain: kinks of further bounces and of total reflection are not among them.
std::vector<double> masking_kinks(const SceneModel& scene);

}  // namespace dolp
