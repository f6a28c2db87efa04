// Scenes.
#include "fuzz.hpp"
#include "scene/scene_reader.hpp"

void dolp::fuzz::read(const std::string& text) {
  // What a table knows in the place of named files: nothing, so that none is opened.
  static const dolp::KnownData nothing;
  refused([&] { dolp::parse_scene(text, "scene.toml", {}, &nothing); });
}
