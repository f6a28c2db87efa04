// Reads a scene file (TOML) into a validated Scene.
#pragma once

#include <dolp/key.hpp>
#include <optional>
#include <string>
#include <vector>

#include <filesystem>
#include "scene/scene.hpp"

namespace dolp {

/// Reads the scene at `path` ("-" is stdin), applies the settings in order and validates the result. Files named in a
/// scene are relative to the folder of the scene (of the process for "-").
/// Errors: InputError, one line: `file:line: key = value: what is wrong and what is allowed`. For a setting its origin
/// begins the line. A file that cannot be opened is an InputError too.
SceneValues read_scene(const std::string& path, const std::vector<Setting>& settings = {});

/// The scene with more settings. Domain: a scene that was read. Errors: InputError, as read_scene.
SceneValues with_settings(const SceneValues& scene, const std::vector<Setting>& settings);

/// n, k, E0 and the sky as they were when the table was computed. They replace the names in its scene.
struct KnownData {
  std::optional<Material> material = {};
  std::vector<std::optional<Material>> layers = {};  ///< layers of a coating
  std::vector<Material> materials = {};              ///< materials on the grid's axis
  std::optional<ReflectanceTable> reflectance = {};
  std::optional<SpectralTable> irradiance = {};
  std::optional<SkyProfile> profile = {};
  bool may_open_files = false;  ///< for missing data; messages then do not quote their contents
};

/// Reads a scene from a text in memory, for example the scene in a table file. `path_name` is for messages and gives
/// the folder of the files that the scene names. With `known` no file is opened unless `may_open_files` is set: data
/// that `known` lacks are an InputError.
SceneValues parse_scene(const std::string& text, const std::string& path_name,
                        const std::vector<Setting>& settings = {}, const KnownData* known = nullptr);

/// TOML that reads back as the scene: its keys in the order of dolp::keys(), numbers as the shortest text that reads
/// back as the same double, no comments.
///
/// Files that the scene names are written as they are found from `folder`, where the text will be saved.
/// Domain: a scene that was read.
std::string scene_toml(const SceneValues& scene, const std::filesystem::path& folder);

}  // namespace dolp
