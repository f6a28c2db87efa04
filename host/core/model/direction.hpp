#pragma once

#include "model/choices.hpp"
#include "model/slopes.hpp"

namespace dolp {

/// How the program obtains the moments of a direction and a slope distribution.
enum class Treatment {
  kIntegrated,  ///< an evaluator integrates them
  /// The smooth surface's reflectances at theta. Used if sigma is so small that the slope density overflows a float.
  kMirror,
  /// At 90 degrees the moments of a heavy-tailed distribution diverge. Only quotients such as r_q / r_i have limits.
  kDivergentLimit,
};

struct Direction {
  double theta_deg = 0.0;
  double cos_theta = 1.0;  ///< cosine of `used_deg`; for a mirror at 90 degrees a tiny positive number
  double used_deg = 0.0;   ///< zenith for the evaluator: `theta_deg`, or slightly below 90 degrees for a limit at 90
  Treatment treatment = Treatment::kIntegrated;
};

Treatment treatment_of(Distribution distribution, Masking masking, double theta_deg, const SlopeShape& shape);

Direction direction_of(Distribution distribution, Masking masking, double theta_deg, const SlopeShape& shape);

bool is_mirror(const SlopeShape& shape);

/// The zenith itself. If it is 90 degrees and `masking` gives rho and f a limit there: a zenith slightly below 90
/// degrees, because near 90 degrees rho and f differ from their limits in proportion to the cosine of the zenith.
double zenith_before_limit_deg(Masking masking, double zenith_deg);

}  // namespace dolp
