#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scene/scene_document.hpp"
#include "scene/scene_reader.hpp"

namespace dolp {

/// The value of a key, by Key::type: a number; a flag; a word or text; the numbers of an axis, or the ends of bands
/// (from, to, from, to, ...); names.
using KeyValue = std::variant<double, bool, std::string, std::vector<double>, std::vector<std::string>>;

struct SceneKey {
  Key description;
  /// Gives the value to a scene. After the last key of a scene, call follow_keys().
  std::function<void(SceneValues& scene, const KeyValue& value)> set;
  /// Reads the value from a scene. Nullopt if the scene lacks it, for example n of a named material.
  std::function<std::optional<KeyValue>(const SceneValues& scene)> value;
};

/// Keys of one alternative of a KeyChoice. A scene chooses it by a key of `heads`, and may also have `companions`.
struct KeyAlternative {
  std::vector<std::string> heads;
  std::vector<std::string> companions = {};

  std::vector<std::string> keys() const;  ///< the heads, then the companions
};

/// Alternatives of which a scene can have only one, such as a constant n and a material.
struct KeyChoice {
  std::string table;
  std::vector<KeyAlternative> alternatives;
  bool is_required = true;  ///< a scene must choose one, unless `table` is an effect or a layer that the scene lacks
};

inline constexpr std::size_t kMostLayers = 16;  ///< most layers of a coating

const std::vector<SceneKey>& scene_key_table();
const std::vector<KeyChoice>& key_choices();
const SceneKey* find_scene_key(std::string_view key);

/// The keys that a scene cannot have beside `key`, because they belong to other alternatives of a KeyChoice.
std::vector<std::string> keys_replaced_by(std::string_view key);

std::string last_part(std::string_view key);  ///< the part behind the last dot: "sigma" of "surface.sigma"

std::vector<std::string> scene_tables();

/// True for a table whose absence removes an effect: emission, source, surroundings, path.
bool is_effect_table(std::string_view table);

/// True for "surface.coating" and for its layers, such as "surface.coating.2".
bool is_coating(std::string_view key);

/// True if KEY=none removes this key or table. A word or text may have the value `none`, so only KEY={} removes it.
bool is_removed_by_none(std::string_view key);

void add_effect(SceneValues& scene, std::string_view table);

/// Computes what follows from keys: slope widths from winds, and skies from numbers. Errors: errors of built_in_sky().
void follow_keys(SceneValues& scene);

/// Reads the value of a key that the document has. Errors: the InputError of SceneDocument::fail.
KeyValue read_value(const SceneDocument& document, const Key& description);

/// The key that a user probably means by the unknown key `key`, for messages: by meaning, else the most similar name.
std::string key_hint(std::string_view key);

/// A hint for messages at a word that the key does not have, such as "ggx" for surface.distribution: the word that a
/// user probably means. Begins with a semicolon; empty if unknown.
std::string word_hint(std::string_view key, std::string_view word);

}  // namespace dolp
