#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <dolp/errors.hpp>

namespace dolp {

/// An interval of finite numbers. It contains both ends, except an end that `ends` calls open.
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
  std::string fallback;                  ///< default value as in a scene file; "required" if none; empty if optional
  std::string meaning;                   ///< meaning of the key in one line, with the symbol of its quantity
  std::vector<std::string> rivals = {};  ///< alternative keys; a scene has at most one of them
  /// Number of the film that the key describes, from 1; 0 if the key describes no film. All films have the same keys.
  std::size_t layer = 0;

  /// The allowed values in words, such as "a number in [0, 90]" or "one of cauchy, gaussian".
  std::string allowed() const;
};

/// Every key that a scene can have, in the order of a scene file. A scene with another key is refused.
DOLP_EXPORT const std::vector<Key>& keys();

}  // namespace dolp
