// Descriptions of the window's controls, scene keys with symbol, scale and equation, and names of surfaces.
#pragma once

#include <dolp/dolp.hpp>

#include "explore/scale.hpp"

namespace dolp::explore {

/// A number of the scene that a slider moves.
struct Parameter {
  const Key* key;
  std::string symbol;    ///< UTF-8
  Scale slider;          ///< a part of the key's range; you can type the rest
  const char* equation;  ///< UTF-8, with its number in the paper where it has one
  /// True where the scene uses the parameter; null: every scene that has it uses it.
  bool (*is_used)(const Scene& scene) = nullptr;

  /// The scene's value; none where the window hides the control.
  std::optional<double> value(const Scene& scene) const;
  /// "λ [µm]".
  std::string label() const;
  /// The position of a value on the slider, from 0 to 1, and the value at a position, rounded to four digits.
  double slider_position(double value) const { return slider.position(slider.clamp(value)); }
  double slider_value(double position) const;
};

/// A word of the scene that a list offers, or a flag that a box shows.
struct Choice {
  const Key* key;
  const char* label;
  const char* equation;

  /// Position in Key::words; none where the window hides the control.
  std::optional<std::size_t> word(const Scene& scene) const;
  bool is_flag() const { return key->words.front() == "false"; }
};

/// The scene key of this name, which must exist.
const Key& described(const std::string& key);

/// All controls, in the order of the scene keys; the numbers of films come last.
const std::vector<Parameter>& parameters();
const std::vector<Choice>& choices();

/// The parameter with this key, which must exist.
const Parameter& parameter(const std::string& key);

/// The range of a parameter's slider, without the values that the scene's masking excludes.
Scale range_in(const Scene& scene, const Parameter& parameter);

/// The table of a dotted key: "surface" of "surface.sigma", "surface.coating.1" of "surface.coating.1.n".
std::string table_of(const std::string& key);

/// The unit for readers: empty for 1, "°" for degree.
std::string unit_text(const Key& key);

bool is_bistatic(const Scene& scene);

/// The surface of a scene in few words: "cauchy σ 0.15 q 3, smith, n 1.5 k 0.1". With `other` only the words of the
/// shape that differ from it, or, where all of them and the material are common, the other numbers that differ; and the
/// material.
std::string surface_name(const Scene& scene, const Scene* other = nullptr);

}  // namespace dolp::explore
