// Fuzzes the overrides of a scene, one KEY=VALUE per line as in `--set`.
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "fuzz.hpp"
#include "scene/scene_reader.hpp"

void dolp::fuzz::read(const std::string& text) {
  const auto nothing = std::make_shared<dolp::KnownData>();
  std::vector<std::string> overrides;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) overrides.push_back(line);
  const char* scene = "[surface]\nn = 1.5\nk = 0.1\n[emission]\n[spectrum]\nwavelength_um = 10.0\n";
  refused([&] { dolp::parse_scene(scene, "scene.toml", dolp::settings_from_text(overrides), nothing); });
}
