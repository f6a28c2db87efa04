// Values along a line: axes of plots and maps, sliders, colours.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace dolp::explore {

/// A range of values at positions from 0 to 1. Domain: ranges whose refusal() is empty.
struct Scale {
  double from = 0.0;
  double to = 1.0;
  bool is_log = false;

  /// Why a range that was read or typed cannot be drawn; empty for one that can.
  std::string refusal() const;
  /// The value at a position, and the position of a value. Both may lie outside the range.
  double value(double position) const;
  double position(double value) const;
  double clamp(double value) const;
  /// The value at a position with four digits, within the range.
  double rounded(double position) const;
  /// `count` values at equal steps of the position, both ends among them.
  std::vector<double> values(std::size_t count) const;
  /// The range between two positions, which may lie outside the range.
  Scale between(double first, double last) const { return {value(first), value(last), is_log}; }
  /// This range shifted into `all`; all of it if this range is larger.
  Scale within(const Scale& all) const;
  /// This range, extended to a value that it can show.
  Scale including(double value) const;
  /// This range as a linear or a logarithmic one. A logarithmic range from 0 begins at 1/180 of its end: 0.5 of 90.
  Scale with_log(bool wants_log) const;

  /// Round values in the range, at most `most`, which is at least 2. Linear: multiples of 1, 2 or 5 times a power of
  /// ten. Logarithmic: powers of ten, with 2 and 5 between them where there is room; linear ticks where fewer than
  /// three of these fit.
  std::vector<double> ticks(std::size_t most) const;

  friend bool operator==(const Scale&, const Scale&) = default;
};

/// The part of a plot that the mouse or typed ends have chosen; none: all of the axis.
struct Zoom {
  std::optional<Scale> x, y;
  friend bool operator==(const Zoom&, const Zoom&) = default;
};

/// A range for the values of curves, with room above them. A linear one contains 0; a logarithmic one leaves out values
/// that are not positive. Values that are not finite do not count.
Scale range_of(std::vector<double> values, bool is_log);

/// The number beside a tick, with four digits at most.
std::string tick_text(double value);

}  // namespace dolp::explore
