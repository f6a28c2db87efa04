// Writes a scene with its overrides applied.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace dolp {

/// TOML that reads back as the scene that parse_scene makes of the same arguments: its keys in the order of
/// scene_keys(), numbers as the shortest text that reads back as the same double, no comments.
///
/// Files that the scene names are written as they are found from `folder`, where the text will be saved.
/// Errors: InputError as parse_scene.
std::string scene_toml(const std::string& text, const std::string& path_name, const std::vector<std::string>& overrides,
                       const std::filesystem::path& folder);

}  // namespace dolp
