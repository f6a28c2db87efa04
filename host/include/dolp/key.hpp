#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <dolp/errors.hpp>

namespace dolp {

/// An interval of finite numbers. It contains both ends, except `min` if kOpenBelow and `max` if kOpenAbove.
struct DOLP_EXPORT NumberRange {
  enum class Ends { kClosed, kOpenBelow, kOpenAbove };
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  Ends ends = Ends::kClosed;

  /// True if the value is in the interval; false for NaN and infinities.
  bool contains(double value) const;
  /// The interval as text for messages, for example "(0, 1e6]". An infinite upper end is written "inf)".
  std::string text() const;
};

struct DOLP_EXPORT Key {
  enum class Type { kNumber, kWord, kFlag, kText, kPair, kAxis, kNames, kPairs };
  std::string key;  ///< table and key of a scene file, with a dot: "surface.sigma"
  Type type = Type::kNumber;
  std::string unit;                      ///< "1" for numbers without a unit, empty for words and texts
  NumberRange range;                     ///< allowed range of a number, and of each value of pairs and axes
  std::vector<std::string> words;        ///< allowed words
  std::string fallback;                  ///< default value, "required" (scenes must have the key), or "" (optional key)
  std::string meaning;                   ///< meaning of the key in one line, with the symbol of its quantity
  std::vector<std::string> rivals = {};  ///< keys that exclude this key: a scene that has this key has none of them
  /// Number of the film that the key describes, such as 1 for "surface.coating.1.n"; 0 for keys that describe no film.
  std::size_t layer = 0;

  /// The allowed values in words, such as "a number in [0, 90]" or "one of cauchy, gaussian".
  std::string allowed() const;
};

/// Every key that a scene can have, in the order of a scene file. Scenes with unknown keys are refused.
DOLP_EXPORT const std::vector<Key>& keys();

/// A key, or a table of keys, that a user probably means by an unknown name.
struct DOLP_EXPORT KeyHint {
  std::string key;
  std::string why;  ///< how it differs from what the user wrote; may be empty

  std::string text() const;  ///< for messages: "surface.sigma (a slope, not a height; ...)"
};
/// The key for another usual name of a quantity, such as surface.sigma for "surface.roughness" or "roughness".
DOLP_EXPORT std::optional<KeyHint> key_by_meaning(std::string_view unknown);

}  // namespace dolp
