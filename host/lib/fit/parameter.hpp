// What a fit varies.
#pragma once

#include <optional>
#include <string>

namespace dolp::fit {

/// A number of the scene, and the range it is looked for in.
///
/// Its coordinate runs from 0 at `low` to 1 at `high`: along the logarithm where a positive range spans a decade or
/// more, else along the value.
struct Parameter {
  std::string key;  ///< of the scene
  double low = 0.0;
  double high = 1.0;
  std::optional<double> start;

  bool is_logarithmic() const { return low > 0.0 && high >= 10.0 * low; }
  double at(double coordinate) const;
  double coordinate(double value) const;
  /// d value / d coordinate.
  double slope(double value) const;
};

/// Reads "KEY=LOW:HIGH" or "KEY=LOW:HIGH:START".
/// Errors: InputError, one line: an unknown key or one that is no number, LOW >= HIGH, a START outside of them, values
/// out of the key's range.
Parameter parse_parameter(const std::string& argument);

}  // namespace dolp::fit
