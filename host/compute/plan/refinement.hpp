#pragma once

#include <memory>
#include <optional>
#include <tuple>

#include <dolp/results.hpp>
#include "model/moments.hpp"
#include "scene/scene.hpp"

namespace dolp {

struct RefinementLevel {
  Precision precision = Precision::kFloat;
  double tolerance = 1e-4;                          ///< MomentsRequest::tolerance
  bool may_interpolate = false;                     ///< interpolation over slope distributions is allowed
  bool is_check = false;                            ///< comes from check_level(), which splits the slopes differently
  std::shared_ptr<const ResponseBasis> basis = {};  ///< MomentsRequest::basis
  /// Orders by cost: float before double, then wide tolerances before tight ones.
  friend bool operator<(const RefinementLevel& a, const RefinementLevel& b) {
    return std::tuple(a.precision, -a.tolerance, a.may_interpolate) <
           std::tuple(b.precision, -b.tolerance, b.may_interpolate);
  }
};

/// Uses float if the tolerance is well above the rounding of float, unless the scene sets the precision.
RefinementLevel first_level(const Accuracy& accuracy, bool has_double);

/// The level that checks results of `first`. It splits the slope axis at more slopes. Its tolerance is 1/100 of the
/// tolerance of `first`, or as small as its precision allows.
RefinementLevel check_level(const RefinementLevel& first);

/// The level at which an entry is computed again after `last`. Its tolerance is smaller by the factor by which `result`
/// misses the tolerance, rounded up to half a decade. Uses double if float is not accurate enough. Empty if `result`
/// meets the tolerance or no tighter level exists.
std::optional<RefinementLevel> next_level(const RefinementLevel& last, const PointResult& result,
                                          const Accuracy& accuracy, bool has_double);

}  // namespace dolp
