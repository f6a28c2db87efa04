// Descriptions of the window's controls: scene keys with symbol, scale and equation.
#pragma once

#include <cstddef>
#include <dolp/dolp.hpp>
#include <optional>
#include <string>
#include <vector>

#include "explore/scale.hpp"

namespace dolp::explore {

/// A number of the scene that a slider moves.
struct Parameter {
  const Key* key;
  const char* symbol;    ///< UTF-8
  Scale slider;          ///< a part of the key's range; typing reaches all of it
  const char* equation;  ///< UTF-8, with its number in the paper where it has one
  /// True where the scene uses the parameter; null: used by every scene that has it.
  bool (*is_used)(const Scene& scene) = nullptr;

  /// The scene's value; none where the control is not shown.
  std::optional<double> value(const Scene& scene) const;
  /// The position of a value on the slider, 0 to 1, and back, rounded to four digits.
  double slider_position(double value) const { return slider.position(slider.clamp(value)); }
  double slider_value(double position) const;
};

/// A word of the scene that a list offers, or a flag that a box shows.
struct Choice {
  const Key* key;
  const char* label;
  const char* equation;

  /// Position in Key::words; none where the control is not shown.
  std::optional<std::size_t> word(const Scene& scene) const;
  bool is_flag() const { return key->words.front() == "false"; }
};

/// The key of this name, which must exist.
const Key& described(const std::string& key);

/// All of them, in the order of the scene keys.
const std::vector<Parameter>& parameters();
const std::vector<Choice>& choices();

/// The one with this key, which must exist.
const Parameter& parameter(const std::string& key);

/// The range of a parameter's slider, without what the scene's masking excludes.
Scale range_in(const Scene& scene, const Parameter& parameter);

/// The table of a dotted key: "surface" of "surface.sigma".
std::string table_of(const std::string& key);

/// The unit as a reader wants it: empty for 1, "°" for degree.
std::string unit_text(const Key& key);

bool is_bistatic(const Scene& scene);

}  // namespace dolp::explore
