// Scenes.
#include <memory>

#include "fuzz.hpp"
#include "scene/scene_reader.hpp"

void dolp::fuzz::read(const std::string& text) {
  // The reader opens no file that the table names, and this table stores no data.
  const auto nothing = std::make_shared<dolp::KnownData>();
  refused([&] { dolp::parse_scene(text, "scene.toml", {}, nothing); });
}
