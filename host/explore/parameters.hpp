// What the window's controls are made of: scene keys with symbol, scale and equation.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "scene/scene_reader.hpp"

namespace dolp::explore {

/// A number of the scene that a slider moves.
struct Parameter {
  const KeyDescription* description;  ///< key, unit, range, meaning
  const char* symbol;                 ///< UTF-8
  NumberRange slider;                 ///< the part of the range that the slider covers; typing reaches all of it
  bool is_log;                        ///< the slider's scale
  const char* equation;               ///< UTF-8, with its number in the paper where it has one
  /// The scene's value; none where the scene does not have the key and the control is not shown.
  std::optional<double> (*value)(const Scene& scene);
};

/// A word of the scene that a list offers, or a flag that a box shows.
struct Choice {
  const KeyDescription* description;
  const char* label;
  const char* equation;
  /// Position in words_of(*description); none where the control is not shown.
  std::optional<std::size_t> (*word)(const Scene& scene);
};

/// All of them, in the order of the scene keys.
const std::vector<Parameter>& parameters();
const std::vector<Choice>& choices();

/// The one with this key, which must exist.
const Parameter& parameter(const std::string& key);

/// What a choice is among: "false" and "true" for a flag.
std::vector<std::string> words_of(const KeyDescription& description);

/// The table of a dotted key: "surface" of "surface.sigma".
std::string table_of(const std::string& key);

/// The unit as a reader wants it: empty for 1, "°" for degree.
std::string unit_text(const KeyDescription& description);

/// The position of a value on its slider, 0 to 1, and back.
double slider_position(const Parameter& parameter, double value);
double slider_value(const Parameter& parameter, double position);

}  // namespace dolp::explore
