// A scene for tests of the scene reader.
#pragma once

#include <dolp/setting.hpp>
#include <string>
#include <vector>

#include "contains.hpp"
#include "error_text.hpp"
#include "scene/scene_reader.hpp"

namespace dolp {

/// A scene with only the required keys. [surface] is in line 1, [emission] in line 4, [spectrum] in line 6.
inline const std::string kMinimal =
    "[surface]\n"
    "n = 1.5\n"
    "sigma = 0.3\n"
    "[emission]\n"
    "temperature_K = 300\n"
    "[spectrum]\n"
    "wavelength_um = 10.6\n";

inline SceneValues parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_scene(text, "s.toml", settings_from_text(overrides, "--set"));
}

/// The settings of both lists.
template <class Change>
std::vector<Change> joined(std::vector<Change> a, const std::vector<Change>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

inline std::string error_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return error_text([&] { parse(text, overrides); });
}
}  // namespace dolp
