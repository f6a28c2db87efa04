#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace dolp::explore {

/// A linear or logarithmic range of values. The position of a value is 0 at `from` and 1 at `to`. Domain: ranges for
/// which refusal() is empty.
struct Scale {
  double from = 0.0;
  double to = 1.0;
  bool is_log = false;

  std::string refusal() const;  ///< the reason why the range cannot be drawn; empty if it can
  /// The value at a position, and the position of a value. Both may lie outside the range.
  double value(double position) const;
  double position(double value) const {
    return is_log ? std::log(value / from) / std::log(to / from) : (value - from) / (to - from);
  }
  double clamp(double value) const { return std::clamp(value, from, to); }
  double rounded(double position) const;                ///< value rounded to four digits, clamped to the range
  std::vector<double> values(std::size_t count) const;  ///< at equal steps of the position, with both ends
  /// The range between two positions, which may lie outside this range.
  Scale between(double first, double last) const { return {value(first), value(last), is_log}; }
  /// This range shifted into `all`; or `all` itself if this range is larger.
  Scale within(const Scale& all) const {
    const double first = all.position(from), last = all.position(to);
    if (last - first >= 1.0) return all;
    const double shift = std::max(-first, 0.0) + std::min(1.0 - last, 0.0);
    return all.between(first + shift, last + shift);
  }
  /// This range extended to a value, if the scale can show the value.
  Scale including(double value) const {
    return is_log && !(value > 0.0) ? *this : Scale{std::min(from, value), std::max(to, value), is_log};
  }
  /// This range, linear or logarithmic. A logarithmic range cannot begin at 0; it then begins at 1/180 of its end.
  Scale with_log(bool wants_log) const;

  /// Round values in the range, at most `most` of them (at least 2). Linear: multiples of 1, 2 or 5 times a power of
  /// ten. Logarithmic: powers of ten, with 2 and 5 times these if there is room; if the range contains fewer than three
  /// such values, the values of a linear range.
  std::vector<double> ticks(std::size_t most) const;

  friend bool operator==(const Scale&, const Scale&) = default;
};

/// A range for the values of curves, with space above them. A linear range contains 0; a logarithmic range ignores
/// values that are not positive. Values that are not finite are ignored.
Scale range_of(std::vector<double> values, bool is_log);

std::string tick_text(double value);  ///< at most four digits

}  // namespace dolp::explore
