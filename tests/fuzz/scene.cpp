// Scenes.
#include "fuzz.hpp"
#include "scene/scene_reader.hpp"

void dolp::fuzz::read(const std::string& text) {
  // A table stores data instead of the named files. Here it stores none, so no file is opened.
  static const dolp::KnownData nothing;
  refused([&] { dolp::parse_scene(text, "scene.toml", {}, &nothing); });
}
