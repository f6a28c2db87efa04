#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace dolp {

/// One line for each value that was probably meant differently, and for each assumption about data that files lack. It
/// begins like an error message, with the place of the key. Domain: a scene that was read from text.
std::vector<std::string> remarks_on(const SceneValues& scene);

}  // namespace dolp
