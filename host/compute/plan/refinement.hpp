// Selects the rule and precision of an entry, and tighter ones if the result misses the scene's tolerance.
#pragma once

#include <memory>
#include <optional>
#include <tuple>

#include <dolp/results.hpp>
#include "model/moments.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// One way to compute the moments of an entry.
struct RefinementLevel {
  Precision precision = Precision::kFloat;          ///< kFloat or kDouble
  double tolerance = 1e-4;                          ///< MomentsRequest::tolerance
  bool may_interpolate = false;                     ///< interpolation over slope distributions is allowed
  bool is_check = false;                            ///< a level of check_level, which splits the slopes differently
  std::shared_ptr<const ResponseBasis> basis = {};  ///< MomentsRequest::basis
  /// Orders by cost: float before double, wide tolerances before tight tolerances.
  friend bool operator<(const RefinementLevel& a, const RefinementLevel& b) {
    return std::tuple(a.precision, -a.tolerance, a.may_interpolate) <
           std::tuple(b.precision, -b.tolerance, b.may_interpolate);
  }
};

/// The level for the first computation of entries: float if the tolerance is well above its rounding, unless the scene
/// sets the precision.
RefinementLevel first_level(const Accuracy& accuracy, bool has_double);

/// The level that checks entries computed at `first`: with other splits, at a hundredth of the tolerance.
RefinementLevel check_level(const RefinementLevel& first);

/// The next level of an entry: tighter by the factor by which the result misses the tolerance, in steps of half a
/// decade, and in double if float cannot be so accurate. Empty if the result meets the tolerance or no tighter level
/// exists. Pure function.
std::optional<RefinementLevel> next_level(const RefinementLevel& last, const PointResult& result,
                                          const Accuracy& accuracy, bool has_double);

}  // namespace dolp
