#pragma once

#include <string>
#include <string_view>

#include <dolp/key.hpp>

namespace dolp {

/// The key that a user probably means by the unknown key `key`, for messages: by meaning, else the most similar name.
std::string key_hint(std::string_view key);

/// What a user probably means by a word that the key does not have, such as "ggx" for surface.distribution. Begins with
/// a semicolon; empty if unknown.
std::string word_hint(std::string_view key, std::string_view word);

}  // namespace dolp
