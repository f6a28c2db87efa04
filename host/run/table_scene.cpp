#include "run/table_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "base/error.hpp"
#include "scene/scene_reader.hpp"
#include "scene/text.hpp"
#include "table/table_file.hpp"

namespace dolp {
namespace {

/// A text attribute, or nullptr.
const std::string* find_text(const Table& table, std::string_view attribute) {
  const auto found = std::ranges::find(table.attributes, attribute, &Attribute::name);
  return found == table.attributes.end() ? nullptr : std::get_if<std::string>(&found->value);
}

/// Whether a line begins an override: a key, dotted or at the top of a scene, and an equals sign.
bool begins_override(std::string_view line) {
  const std::string_view key = trim(line.substr(0, line.find('=')));
  if (line.find('=') == std::string_view::npos) return false;
  return std::ranges::any_of(scene_keys(), [key](const KeyDescription& known) {
    return known.key == key || known.key.starts_with(std::string(key) + '.') || key.starts_with(known.key + '.');
  });
}

}  // namespace

std::string overrides_text(const std::vector<std::string>& overrides) {
  std::string text;
  for (const std::string& change : overrides) text += (text.empty() ? "" : "\n") + change;
  return text;
}

std::vector<std::string> overrides_of(const std::string& text) {
  std::vector<std::string> overrides;
  if (text.empty()) return overrides;
  for (const std::string_view line : split(text, '\n')) {
    if (overrides.empty() || begins_override(line)) {
      overrides.emplace_back(line);
    } else {
      (overrides.back() += '\n') += line;
    }
  }
  return overrides;
}

std::uint64_t scene_seed(const Scene& scene) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  const auto add = [&hash](const std::string& text) {
    for (const char byte : text) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3U;
  };
  add(scene.text);
  for (const std::string& change : scene.overrides) add("\n" + change);
  return hash;
}

std::string scene_hash(const Scene& scene) { return fmt::format("fnv1a64:{:016x}", scene_seed(scene)); }

Table load_table(const std::string& path) {
  if (!std::filesystem::exists(path)) throw InputError(path + ": there is no such file");
  const std::string suffix = std::filesystem::path(path).extension().string();
  if (suffix == ".csv" || suffix == ".npy") {
    throw InputError(
        fmt::format("{}: only a table written as .nc holds its scene, which {} files do not in full", path, suffix));
  }
  return read_table(path);
}

Scene table_scene(const Table& table, const std::string& name) {
  const std::string* text = find_text(table, "scene");
  if (!text) {
    throw InputError(
        fmt::format("{}: has no attribute \"scene\"; only a table that dolp wrote as .nc holds its scene", name));
  }
  const std::string* overrides = find_text(table, "scene_overrides");
  const std::string* path = find_text(table, "scene_path");
  Scene scene;
  try {
    scene = parse_scene(*text, path ? *path : name, overrides ? overrides_of(*overrides) : std::vector<std::string>{});
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: attribute \"scene\": {}", name, error.what()));
  }
  const std::string* hash = find_text(table, "scene_hash");
  if (hash && *hash != scene_hash(scene)) {
    throw InputError(
        fmt::format("{}: attribute \"scene_hash\" is {}, but its scene has {}: the scene was changed after "
                    "the table was made",
                    name, one_line(*hash), scene_hash(scene)));
  }
  return scene;
}

}  // namespace dolp
