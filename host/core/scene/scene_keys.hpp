// The list of all scene keys: allowed values, and how a scene holds them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene_document.hpp"
#include "scene/scene_reader.hpp"

namespace dolp {

/// A value that its Key allows.
struct KeyValue {
  double number = 0.0;
  std::size_t word = 0;              ///< position in Key::words
  std::string text = {};             ///< also the text of a word or a flag
  std::vector<double> numbers = {};  ///< values of a pair, an axis, or pairs one after the other
  std::vector<std::string> names = {};
};

struct SceneKey {
  Key description;
  std::function<void(SceneValues& scene, const KeyValue& value)> set;
  /// None if the scene has no such value: n beside a material, the temperature of an absent emission.
  std::function<std::optional<KeyValue>(const SceneValues& scene)> value;
};

/// Keys that belong together. Any of `heads` chooses the alternative; `companions` need one of these beside them.
struct KeyAlternative {
  std::vector<std::string> heads;
  std::vector<std::string> companions = {};

  std::vector<std::string> keys() const;  ///< heads, then companions
};

/// Alternatives of which a scene has at most one.
struct KeyChoice {
  std::string table;
  std::vector<KeyAlternative> alternatives;
  bool is_required = true;   ///< if the table is there, or must be
  bool is_of_layer = false;  ///< the table is a layer of a coating, which a scene may lack
};

inline constexpr std::size_t kMostLayers = 16;  ///< most layers of a coating

const std::vector<SceneKey>& scene_key_table();
const std::vector<KeyChoice>& key_choices();
const SceneKey* find_scene_key(std::string_view key);

/// The keys that a setting of `key` replaces: the keys of other alternatives.
std::vector<std::string> keys_replaced_by(std::string_view key);

/// The tables in the order of the keys.
std::vector<std::string> scene_tables();

/// True if a scene without that table has no such effect.
bool is_effect_table(std::string_view table);

/// True for the coating of a scene and for one of its layers: "surface.coating", "surface.coating.2".
bool is_coating(std::string_view key);

/// True if the word none removes a key or a table. If none may be a value, `{}` removes it.
bool is_removed_by_none(std::string_view key);

/// Makes the table's effect present in the scene.
void add_effect(SceneValues& scene, std::string_view table);

class SceneDocument;

/// The value of a key that the document has. Errors: InputError through SceneDocument::fail.
KeyValue read_value(const SceneDocument& document, const Key& description);

}  // namespace dolp
