#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <dolp/errors.hpp>

namespace dolp {

/// An interval of finite numbers. It contains its ends, except the end that `ends` calls open.
struct DOLP_EXPORT NumberRange {
  enum class Ends { kClosed, kOpenBelow, kOpenAbove };
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  Ends ends = Ends::kClosed;

  /// True if the value is in the interval; false for NaN and infinities.
  bool contains(double value) const;
  /// The interval as text for messages, for example "(0, 1e6]". An infinite end is written "inf)".
  std::string text() const;
};

struct DOLP_EXPORT Key {
  enum class Type { kNumber, kWord, kFlag, kText, kPair, kAxis, kNames, kPairs };
  std::string key;  ///< dotted: "surface.sigma"
  Type type = Type::kNumber;
  std::string unit;                      ///< "1" for numbers without a unit, empty for words and texts
  NumberRange range;                     ///< allowed range of a number, and of each value of pairs and axes
  std::vector<std::string> words;        ///< allowed words
  std::string fallback;                  ///< default as in a scene file; "required" if there is none; empty if optional
  std::string meaning;                   ///< what the key means, in one line, with its symbol
  std::vector<std::string> rivals = {};  ///< alternative keys; a scene has at most one of them
  /// Number of the film that the key describes; 0 for other keys. All films have the keys of the first one.
  std::size_t layer = 0;

  /// "a number in [0, 90]", "one of cauchy, gaussian", …
  std::string allowed() const;
};

/// Every key that a scene can have, in the order of a scene file. The reader of scenes refuses all others.
DOLP_EXPORT const std::vector<Key>& keys();

}  // namespace dolp
