// Writes a scene with its settings applied.
#pragma once

#include <filesystem>
#include <string>

#include "scene/scene.hpp"

namespace dolp {

/// TOML that reads back as the scene: its keys in the order of dolp::keys(), numbers as the shortest text that reads
/// back as the same double, no comments.
///
/// Files that the scene names are written as they are found from `folder`, where the text will be saved.
/// Domain: a scene that was read.
std::string scene_toml(const SceneValues& scene, const std::filesystem::path& folder);

}  // namespace dolp
