// Selects the rule and precision of an entry, and tighter ones where the result misses the scene's tolerance.
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
  bool may_interpolate = false;                     ///< between slope distributions
  bool is_check = false;                            ///< by a rule of another kind
  std::shared_ptr<const ResponseBasis> basis = {};  ///< MomentsRequest::basis
  /// Orders by cost: float before double, wide tolerances before tight tolerances.
  friend bool operator<(const RefinementLevel& a, const RefinementLevel& b) {
    return std::tuple(a.precision, -a.tolerance, a.may_interpolate) <
           std::tuple(b.precision, -b.tolerance, b.may_interpolate);
  }
};

/// The level at which a scene's entries are computed first: float where the tolerance is well above its
/// rounding, unless the scene sets the precision.
RefinementLevel first_level(const Accuracy& accuracy, bool has_double);

/// The level that checks entries computed at `first`: a rule of another kind, at a hundredth of the tolerance.
RefinementLevel check_level(const RefinementLevel& first);

/// The next level of an entry, tighter by as many half decades as the result misses the tolerance, in double if float
/// cannot be that tight; none if the result meets the tolerance or no tighter level exists. Pure.
std::optional<RefinementLevel> next_level(const RefinementLevel& last, const PointResult& result,
                                          const Accuracy& accuracy, bool has_double);

}  // namespace dolp
