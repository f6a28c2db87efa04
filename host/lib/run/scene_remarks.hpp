// Remarks on a scene: values that were probably meant differently, and assumptions about data that its files lack.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace dolp {

/// One line per remark. A remark begins like an error message, with the place of the key. Domain: a scene that was read
/// from text.
std::vector<std::string> remarks_on(const SceneValues& scene);

}  // namespace dolp
