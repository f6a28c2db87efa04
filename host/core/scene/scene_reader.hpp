#pragma once

#include <dolp/key.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
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

/// Reads the scene at `path` ("-" is stdin), applies the settings in order and validates the result. Paths in the scene
/// are relative to the folder of the scene. If the scene comes from stdin, they are relative to the working folder.
/// Errors: InputError, one line: `file:line: key = value: what is wrong and what is allowed`. If a setting is wrong,
/// the line begins with Setting::origin instead. A file that cannot be opened is an InputError too.
SceneValues read_scene(const std::string& path, const std::vector<Setting>& settings = {});

/// Applies further settings to a scene that was read. Errors: errors of read_scene.
SceneValues with_settings(const SceneValues& scene, const std::vector<Setting>& settings);

/// Makes a scene from a text. `path_name` appears in messages, and paths in the scene are relative to its folder. Data
/// in `known` replace files and built-in data of the same names; see load_named_data().
SceneValues parse_scene(const std::string& text, const std::string& path_name,
                        const std::vector<Setting>& settings = {}, std::shared_ptr<KnownData> known = nullptr);

/// Writes a scene as TOML without comments, with the keys in the order of dolp::keys(). Reading the text gives the same
/// scene. Paths are relative to `folder`, where the text will be saved. Domain: a scene that was read.
std::string scene_toml(const SceneValues& scene, const std::filesystem::path& folder);

}  // namespace dolp
