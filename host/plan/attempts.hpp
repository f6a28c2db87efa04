// With which rule and precision an entry is computed, and with which again where that misses the scene's tolerance.
#pragma once

#include <cstdint>
#include <optional>

#include "model/point_result.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// One way to compute the moments of an entry.
struct Attempt {
  Precision precision = Precision::kFloat;  ///< kFloat or kDouble
  double tolerance = 1e-4;                  ///< of the rule: MomentsRequest::tolerance
  bool is_check = false;                    ///< by a rule of another kind, rows as wide as those of the first attempt
  std::uint32_t row_width = 0;              ///< MomentsRequest::row_width
  /// In the order of their cost: float before double, wide tolerances before tight ones.
  friend bool operator<(const Attempt& a, const Attempt& b) {
    return a.precision != b.precision ? a.precision < b.precision : a.tolerance > b.tolerance;
  }
};

/// The first attempt at a scene's entries: float where its rounding leaves room for the tolerance, unless the scene
/// says otherwise.
Attempt first_attempt(const Accuracy& accuracy, bool has_double);

/// What entries are checked with that `first` computed: a rule of another kind, for a hundredth of the tolerance.
Attempt check_attempt(const Attempt& first, std::uint32_t row_width);

/// The next attempt at an entry, tighter by as many half decades as the result misses the tolerance by, in double once
/// float cannot do that; none when it meets the tolerance, or nothing better is left. Depends on nothing but its
/// arguments.
std::optional<Attempt> next_attempt(const Attempt& last, const PointResult& result, const Accuracy& accuracy,
                                    bool has_double);

}  // namespace dolp
