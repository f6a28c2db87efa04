#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace dolp::explore {

/// A linear or logarithmic range. The position of a value is 0 at `from`, 1 at `to`. Domain: refusal() returns "".
struct Scale {
  double from = 0.0;
  double to = 1.0;
  bool is_log = false;

  std::string refusal() const;          ///< the reason why the range cannot be drawn; empty if it can
  double value(double position) const;  ///< `position` may lie outside [0, 1]
  double position(double value) const {
    return is_log ? std::log(value / from) / std::log(to / from) : (value - from) / (to - from);
  }
  double clamp(double value) const { return std::clamp(value, from, to); }
  double rounded(double position) const;                ///< value(position) with four significant digits, clamped
  std::vector<double> values(std::size_t count) const;  ///< `count` values at equal steps of position
  Scale between(double first, double last) const { return {value(first), value(last), is_log}; }
  /// This range, shifted so that it lies in `all`. If this range is larger than `all`, returns `all`.
  Scale within(const Scale& all) const {
    const double first = all.position(from), last = all.position(to);
    if (last - first >= 1.0) return all;
    const double shift = std::max(-first, 0.0) + std::min(1.0 - last, 0.0);
    return all.between(first + shift, last + shift);
  }
  /// This range, extended so that it contains `value`. Unchanged if a logarithmic scale cannot show `value`.
  Scale including(double value) const {
    return is_log && !(value > 0.0) ? *this : Scale{std::min(from, value), std::max(to, value), is_log};
  }
  /// This range, made linear or logarithmic. If from <= 0, a logarithmic range begins at to / 180: 0.5° for to = 90°.
  Scale with_log(bool wants_log) const;

  /// Round values for at most `most` ticks (`most` >= 2). A linear range has multiples of 1, 2 or 5 times a power of
  /// ten. A logarithmic range has 1, 2 and 5 times powers of ten. If it contains fewer than three such values, it gets
  /// the ticks of a linear range. If it contains too many, it gets all powers of ten, or some at equal distances.
  std::vector<double> ticks(std::size_t most) const;

  friend bool operator==(const Scale&, const Scale&) = default;
};

/// A range for a plot of `values`, with space above the largest. A linear range contains 0. Ignores values that are not
/// finite, and for a logarithmic range also values that are not positive.
Scale value_scale(std::vector<double> values, bool is_log);

std::string tick_text(double value);  ///< label of a tick, with at most four digits

}  // namespace dolp::explore
