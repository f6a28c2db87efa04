#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene_document.hpp"
#include "scene/scene_reader.hpp"

namespace dolp {

/// A value of a key. Which members are set depends on Key::type.
struct KeyValue {
  double number = 0.0;
  std::size_t word = 0;              ///< position in Key::words
  std::string text = {};             ///< value of a text; also the text of a word or a flag
  std::vector<double> numbers = {};  ///< values of a pair, of several pairs one after the other, or of an axis
  std::vector<std::string> names = {};
};

struct SceneKey {
  Key description;
  std::function<void(SceneValues& scene, const KeyValue& value)> set;
  /// Nullopt if the scene lacks the value, for example n of a named material, or the temperature without emission.
  std::function<std::optional<KeyValue>(const SceneValues& scene)> value;
};

/// Keys that belong together. Any of `heads` chooses the alternative; `companions` also need one of the heads.
struct KeyAlternative {
  std::vector<std::string> heads;
  std::vector<std::string> companions = {};

  std::vector<std::string> keys() const;  ///< heads, then companions
};

/// Alternatives of which a scene has at most one.
struct KeyChoice {
  std::string table;
  std::vector<KeyAlternative> alternatives;
  bool is_required = true;   ///< one alternative must be chosen, unless an optional table is absent
  bool is_of_layer = false;  ///< the table is a layer of a coating, so it may be absent
};

inline constexpr std::size_t kMostLayers = 16;  ///< most layers of a coating

const std::vector<SceneKey>& scene_key_table();
const std::vector<KeyChoice>& key_choices();
const SceneKey* find_scene_key(std::string_view key);

/// The keys of the alternatives that exclude `key`.
std::vector<std::string> keys_replaced_by(std::string_view key);

std::vector<std::string> scene_tables();

/// True for a table whose absence removes an effect: emission, source, surroundings, path.
bool is_effect_table(std::string_view table);

/// True for the coating or one of its layers: "surface.coating", "surface.coating.2".
bool is_coating(std::string_view key);

/// True if the value `none` removes a key or a table. Where `none` may be a value, only `{}` removes the key.
bool is_removed_by_none(std::string_view key);

void add_effect(SceneValues& scene, std::string_view table);

class SceneDocument;

/// Reads the value of a key that the document has. Errors: InputError by SceneDocument::fail.
KeyValue read_value(const SceneDocument& document, const Key& description);

}  // namespace dolp
