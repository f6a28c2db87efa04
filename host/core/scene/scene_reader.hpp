#pragma once

#include <dolp/key.hpp>
#include <optional>
#include <string>
#include <vector>

#include <filesystem>
#include "scene/scene.hpp"

namespace dolp {

/// Reads the scene at `path` ("-" is stdin), applies the settings in order and validates the result. Paths in a scene
/// are relative to its folder; for "-", to the working folder of the process.
/// Errors: InputError, one line: `file:line: key = value: what is wrong and what is allowed`. If a setting is wrong,
/// its origin begins the line. A file that cannot be opened is an InputError too.
SceneValues read_scene(const std::string& path, const std::vector<Setting>& settings = {});

/// The scene after more settings. Domain: a scene that was read. Errors: InputError, in the form of read_scene.
SceneValues with_settings(const SceneValues& scene, const std::vector<Setting>& settings);

/// Data of a table file, as they were when the table was computed. They replace files and built-in data.
struct KnownData {
  std::optional<Material> material = {};
  std::vector<std::optional<Material>> layers = {};  ///< layers of a coating
  std::vector<Material> materials = {};              ///< materials on the grid's axis
  std::optional<ReflectanceTable> reflectance = {};
  std::optional<SpectralTable> irradiance = {};
  std::optional<SkyProfile> profile = {};
  bool may_open_files = false;  ///< opens files for missing data; messages then do not quote the files
};

/// `path_name` is for messages, and its folder is the folder for the paths in the scene. With `known`, the reader opens
/// files only if `may_open_files` is set; otherwise an InputError reports missing data of files.
SceneValues parse_scene(const std::string& text, const std::string& path_name,
                        const std::vector<Setting>& settings = {}, const KnownData* known = nullptr);

/// Writes a scene as TOML that reads back as the same scene, without comments, with keys in the order of dolp::keys().
/// Paths of files are relative to `folder`, where the text will be saved. Domain: a scene that was read.
std::string scene_toml(const SceneValues& scene, const std::filesystem::path& folder);

}  // namespace dolp
