// Reads a scene file (TOML) into a validated Scene.
#pragma once

#include <dolp/key.hpp>
#include <optional>
#include <string>
#include <vector>

#include <dolp/number_range.hpp>
#include "scene/scene.hpp"

namespace dolp {

/// Reads the scene at `path` ("-" is stdin), applies the settings in order and validates the result. Files named in a
/// scene are relative to the folder of the scene (of the process for "-").
/// Errors: InputError, one line: `file:line: key = value: what is wrong and what is allowed`, of a setting its origin
/// instead; a file that cannot be opened is an InputError too.
SceneValues read_scene(const std::string& path, const std::vector<Setting>& settings = {});

/// The scene with more settings. Domain: a scene that was read. Errors: InputError, as read_scene.
SceneValues with_settings(const SceneValues& scene, const std::vector<Setting>& settings);

/// n, k, E0 and the sky as they were when the table was computed, in place of the names in its scene.
struct KnownData {
  std::optional<Material> material = {};
  std::vector<std::optional<Material>> layers = {};  ///< of a coating
  std::vector<Material> materials = {};              ///< of the axis of materials
  std::optional<ReflectanceTable> reflectance = {};
  std::optional<SpectralTable> irradiance = {};
  std::optional<SkyProfile> profile = {};
  bool may_open_files = false;  ///< for missing data; messages then do not quote their contents
};

/// The same for a text that is already in memory (the scene that a table file carries); `path_name` is for messages and
/// gives the folder of the files the scene names. With `known` none of these is opened, unless it says so: an
/// InputError where it lacks what the scene takes from one.
SceneValues parse_scene(const std::string& text, const std::string& path_name,
                        const std::vector<Setting>& settings = {}, const KnownData* known = nullptr);

}  // namespace dolp
