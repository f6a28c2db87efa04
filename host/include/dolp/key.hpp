// Keys that scenes have.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <dolp/errors.hpp>

namespace dolp {

/// An interval of finite numbers; each end open or closed.
struct DOLP_EXPORT NumberRange {
  enum class Ends { kClosed, kOpenBelow, kOpenAbove };
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  Ends ends = Ends::kClosed;

  /// False for NaN and infinities.
  bool contains(double value) const;
  /// For messages, for example "(0, 1e6]". An infinite end is written "inf)".
  std::string text() const;
};

/// A key of a scene.
struct DOLP_EXPORT Key {
  enum class Type { kNumber, kWord, kFlag, kText, kPair, kAxis, kNames, kPairs };
  std::string key;  ///< dotted: "surface.sigma"
  Type type = Type::kNumber;
  std::string unit;                      ///< "1" for numbers without a unit, empty for words and texts
  NumberRange range;                     ///< allowed range of a number, and of each value of pairs and axes
  std::vector<std::string> words;        ///< allowed words
  std::string fallback;                  ///< default, as in a scene file; "required"; empty if the key is simply absent
  std::string meaning;                   ///< one line, with the symbol
  std::vector<std::string> rivals = {};  ///< alternative keys; a scene has at most one of them
  std::size_t layer = 0;  ///< number of the film that the key describes; all films have the keys of the first

  /// "a number in [0, 90]", "one of cauchy, gaussian", …
  std::string allowed() const;
};

/// Every key that a scene can have, in the order of a scene file. The reader accepts only these.
DOLP_EXPORT const std::vector<Key>& keys();

}  // namespace dolp
