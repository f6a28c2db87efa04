#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace dolp {

/// One line for each value that was probably meant differently, and for each assumption where a file lacks data. A line
/// begins like an error message, with the scene file and the line of the key. Domain: a scene that was read from text.
std::vector<std::string> remarks_on(const SceneValues& scene);

}  // namespace dolp
