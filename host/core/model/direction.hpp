// Treatment of one direction and one slope distribution, decided in one place.
#pragma once

#include "model/choices.hpp"
#include "model/slopes.hpp"

namespace dolp {

/// Method that gives the moments.
enum class Treatment {
  kIntegrated,      ///< by an evaluator
  kMirror,          ///< sigma so small that the slopes' density overflows a float: R at the direction itself
  kDivergentLimit,  ///< at 90 degrees those of a heavy tail diverge, and only their quotients have a limit
};

/// A direction with the treatment of its moments.
struct Direction {
  double theta_deg = 0.0;
  double cos_theta = 1.0;  ///< that the moments are computed with: exact but for limits at 90 degrees
  double used_deg = 0.0;   ///< passed to an evaluator: `theta_deg`, or just before 90 degrees for a limit there
  Treatment treatment = Treatment::kIntegrated;
};

Treatment treatment_of(Distribution distribution, Masking masking, double theta_deg, const SlopeShape& shape);

Direction direction_of(Distribution distribution, Masking masking, double theta_deg, const SlopeShape& shape);

bool is_mirror(const SlopeShape& shape);

/// The zenith itself, or just before 90 degrees where rho and f have a limit there, which they approach like the
/// cosine.
double zenith_before_limit_deg(Masking masking, double zenith_deg);

}  // namespace dolp
