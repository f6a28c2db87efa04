#pragma once

#include <optional>
#include <vector>

#include "scene/scene.hpp"
#include "scene/scene_document.hpp"

namespace dolp {

/// Data from a table. The table was computed with them, so they replace the files and built-in data of the same names.
struct KnownData {
  std::string table;                     ///< path of the table, or another name of it
  std::optional<SceneNames> names = {};  ///< names of the data in the table's scene; load_named_data() sets them once
  std::vector<std::string> axis_names = {};  ///< names on the grid's axis of materials, set with `names`
  std::optional<Material> material = {};
  std::vector<std::optional<Material>> layers = {};  ///< layers of a coating
  std::vector<Material> materials = {};              ///< materials on the grid's axis
  std::optional<ReflectanceTable> reflectance = {};
  std::optional<SpectralTable> irradiance = {}, response = {}, diffuse = {};
  std::optional<SkyProfile> profile = {};
  bool may_open_files = false;  ///< allows opening files for missing data; error messages quote no text of the files
};

/// Loads the data that a scene names: response of the camera, materials, measured reflectances, diffuse reflectance,
/// irradiance of the source, and sky. Takes them from scene.known if the name is the same there; else from built-in
/// data, or from files, whose paths are relative to the folder of scene.path_name. Errors: InputError that begins with
/// the file, line and key.
void load_named_data(SceneValues& scene, const SceneDocument& document);

}  // namespace dolp
