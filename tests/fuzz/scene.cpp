// Scenes.
#include "fuzz.hpp"
#include "scene/scene_reader.hpp"

void dolp::fuzz::read(const std::string& text) {
  // With KnownData the reader does not open files. It takes their data from KnownData, which is empty here.
  static const dolp::KnownData nothing;
  refused([&] { dolp::parse_scene(text, "scene.toml", {}, &nothing); });
}
