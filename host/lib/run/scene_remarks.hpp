#pragma once

#include <string>
#include <vector>

#include "scene/points.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// One line for each value that was probably meant differently, and for each assumption where a file lacks data. A line
/// begins like an error message, with the scene file and the line of the key. Domain: a scene that was read from text.
std::vector<std::string> remarks_on(const SceneValues& scene);

/// The same for values in the columns of points. Such lines begin with the file of the points and the line of its
/// header.
std::vector<std::string> remarks_on(const SceneValues& scene, const Points& points);

/// The keys to change if entries of the scene have the status bit kModelInaccurate. Names only what the scene allows:
/// no model follows all bounces of a coating or of measured reflectances. Domain: scattering is single.
std::string model_advice(const SceneModel& scene);

}  // namespace dolp
