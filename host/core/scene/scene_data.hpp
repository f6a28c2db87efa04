#pragma once

#include <optional>
#include <vector>

#include "scene/scene.hpp"
#include "scene/scene_document.hpp"

namespace dolp {

/// Data from a table file. The table was computed with them, so they replace data files and built-in data.
struct KnownData {
  std::optional<Material> material = {};
  std::vector<std::optional<Material>> layers = {};  ///< layers of a coating
  std::vector<Material> materials = {};              ///< materials on the grid's axis
  std::optional<ReflectanceTable> reflectance = {};
  std::optional<SpectralTable> irradiance = {};
  std::optional<SkyProfile> profile = {};
  bool may_open_files = false;  ///< allows opening files for missing data; error messages quote no text of the files
};

/// Loads the data that a scene names: materials, measured reflectances, irradiance of the source, and sky. Paths are
/// relative to the folder of scene.path_name. Errors: InputError that begins with the file, line and key.
void load_named_data(SceneValues& scene, const SceneDocument& document, const KnownData* known);

}  // namespace dolp
