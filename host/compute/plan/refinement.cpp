#include "plan/refinement.hpp"

#include <algorithm>
#include <cmath>

#include <dolp/status.hpp>
#include "model/moments.hpp"
#include "plan/constants.hpp"

namespace dolp {
namespace {

constexpr double kLeastDoubleTolerance = 1e-15;  // the smallest tolerance of rules in double

bool may_use_double(const Accuracy& accuracy, bool has_double) {
  return has_double && accuracy.precision != Precision::kFloat;
}

// Rounds a number of decades up to a multiple of 1/2, so that many entries share a level.
double half_decades(double decades) { return 0.5 * std::ceil(2.0 * decades); }

}  // namespace

RefinementLevel first_level(const Accuracy& accuracy, bool has_double) {
  const bool wants_double = accuracy.precision == Precision::kDouble || accuracy.tolerance < kLeastFloatTolerance;
  const bool is_double = wants_double && may_use_double(accuracy, has_double);
  return {.precision = is_double ? Precision::kDouble : Precision::kFloat,
          .tolerance = accuracy.tolerance,
          .may_interpolate = accuracy.may_interpolate};
}

RefinementLevel check_level(const RefinementLevel& first) {
  constexpr double kFinerBy = 1e-2;
  const double least = first.precision == Precision::kFloat ? kLeastFloatTolerance : kLeastDoubleTolerance;
  return {.precision = first.precision,
          .tolerance = std::max(kFinerBy * first.tolerance, std::min(least, first.tolerance)),
          .is_check = true};
}

std::optional<RefinementLevel> next_level(const RefinementLevel& last, const PointResult& result,
                                          const Accuracy& accuracy, bool has_double) {
  if ((result.status & kAnyToleranceNotMet) == 0) return std::nullopt;
  // Outside the model's domain DOLP may be known as a limit. If not, its error is NaN, and no tighter level helps.
  const bool is_outside = (result.status & kOutsideModelDomain) != 0;
  if (is_outside && std::isnan(result[Quantity::kErrorEstimate])) return std::nullopt;
  const double rho_error = is_outside ? 0.0 : result[Quantity::kRhoErrorEstimate];
  const double excess =
      std::isnan(rho_error) ? rho_error : std::max(result[Quantity::kErrorEstimate], rho_error) / accuracy.tolerance;
  // A step lowers the tolerance by at least half the decades of all earlier steps, so the last level is reached soon.
  const double so_far = std::log10(accuracy.tolerance / last.tolerance);
  const double least = std::max(kLeastDecades, half_decades(0.5 * so_far));
  const double missed_by = std::isfinite(excess) ? half_decades(std::log10(kRefinementSafety * excess)) : kMostDecades;
  const double decades = std::min(std::max(missed_by, least), kMostDecades);
  const double wanted = last.tolerance * std::pow(10.0, -decades);
  if (last.precision == Precision::kFloat && wanted >= kLeastFloatTolerance)
    return RefinementLevel{.precision = Precision::kFloat, .tolerance = wanted};
  if (!may_use_double(accuracy, has_double)) {
    if (last.precision != Precision::kFloat || last.tolerance <= kLeastFloatTolerance) return std::nullopt;
    return RefinementLevel{.precision = Precision::kFloat, .tolerance = kLeastFloatTolerance};
  }
  const double tolerance = std::max(wanted, kLeastDoubleTolerance);
  if (last.precision == Precision::kDouble && tolerance >= last.tolerance) return std::nullopt;
  return RefinementLevel{.precision = Precision::kDouble, .tolerance = tolerance};
}

}  // namespace dolp
