// What a scene takes that was probably meant otherwise, and what it assumes without being told.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace dolp {

/// One line for each: units that look like others, and data that the files of the scene lack. Each begins like an error
/// message, with the place of the key. Domain: a scene that was read.
std::vector<std::string> remarks_on(const SceneValues& scene);

}  // namespace dolp
