// Values along a line: axes of plots and maps, sliders, colours.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace dolp::explore {

/// A range of values at positions from 0 to 1. Domain: that of refusal().
struct Scale {
  double from = 0.0;
  double to = 1.0;
  bool is_log = false;

  /// Why a range that was read or typed cannot be drawn; empty for one that can.
  std::string refusal() const;
  /// The value at a position; outside of the range that of the nearer end.
  double value(double position) const;
  /// The position of a value, not clamped.
  double position(double value) const;
  double clamp(double value) const;
  /// The range between two positions, which may lie outside.
  Scale between(double first, double last) const;
  /// The range shifted into another one, or all of that if it is larger.
  Scale within(const Scale& all) const;

  /// The same range with another kind of steps. A logarithm of 0 begins at 1/180 of the end, half a degree of 90.
  Scale with_log(bool wants_log) const;

  /// Round values in the range, at most `most`, which is at least 2. Linear: multiples of 1, 2 or 5 times a power of
  /// ten. Logarithmic: powers of ten, with 2 and 5 between them where there is room; as linear where fewer than three
  /// fit.
  std::vector<double> ticks(std::size_t most) const;

  friend bool operator==(const Scale&, const Scale&) = default;
};

/// The part of a plot that is shown, by the mouse or as typed; none: all.
struct Zoom {
  std::optional<Scale> x, y;
  friend bool operator==(const Zoom&, const Zoom&) = default;
};

/// A tick as text, as short as it is exact.
std::string tick_text(double value);

}  // namespace dolp::explore
