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
  std::size_t word = 0;   ///< position in Key::words
  std::string text = {};  ///< a text or a word; for a flag "true" or "false", but read_value() leaves it empty
  std::vector<double> numbers = {};  ///< numbers of an axis, or ends of bands: from, to, from, to, ...
  std::vector<std::string> names = {};
};

struct SceneKey {
  Key description;
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
  bool is_required = true;   ///< a scene must choose one, unless `table` is an effect or a layer that the scene lacks
  bool is_of_layer = false;  ///< `table` is a layer of a coating, so it may be absent
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

class SceneDocument;

/// Reads the value of a key that the document has. Errors: the InputError of SceneDocument::fail.
KeyValue read_value(const SceneDocument& document, const Key& description);

}  // namespace dolp
