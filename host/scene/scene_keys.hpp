// The one list of scene keys: what each may be, and where in the Scene it goes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/scene_reader.hpp"

namespace dolp {

/// The scene under construction: names of files and materials are looked up when all keys are known.
struct SceneDraft {
  Scene scene;
  std::string material;
  std::string material_file;
  std::string source_preset;
  std::string source_file;
};

/// A value that is what its KeyDescription allows.
struct KeyValue {
  double number = 0.0;
  std::size_t word = 0;  ///< position in KeyDescription::words
  std::string text;
  bool is_set = false;          ///< flag
  std::vector<double> numbers;  ///< pair, axis
};

struct SceneKey {
  KeyDescription description;
  void (*set)(SceneDraft& draft, const KeyValue& value);
};

/// Alternatives of which one is chosen; each is a list of keys that belong together, and its first key chooses it.
struct KeyChoice {
  std::string table;
  std::vector<std::vector<std::string>> alternatives;
  bool is_required = true;      ///< if the table is there, or must be
  std::string substitute = {};  ///< a key that does instead
};

const std::vector<SceneKey>& scene_key_table();
const std::vector<KeyChoice>& key_choices();
const SceneKey* find_scene_key(std::string_view key);

/// The tables in the order of the keys.
std::vector<std::string> scene_tables();

/// Whether a scene without that table is a scene without that effect.
bool is_effect_table(std::string_view table);

/// Makes the table's effect present in the scene.
void add_effect(SceneDraft& draft, std::string_view table);

}  // namespace dolp
