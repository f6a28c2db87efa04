// From a TOML value to a checked KeyValue.
#pragma once

#include <string>
#include <string_view>

#include "scene/scene_document.hpp"
#include "scene/scene_keys.hpp"

namespace dolp {

/// The value of a key that the document has. Errors: InputError through SceneDocument::fail.
KeyValue read_value(const SceneDocument& document, const Key& description);

}  // namespace dolp
