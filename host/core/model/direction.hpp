#pragma once

#include "model/choices.hpp"
#include "model/slopes.hpp"

namespace dolp {

/// How the moments of a direction and a slope distribution are obtained.
enum class Treatment {
  kIntegrated,  ///< an evaluator computes them
  /// Reflectances of the smooth surface at theta, because sigma is so small that the slope density overflows a float.
  kMirror,
  /// At 90 degrees the moments of a heavy-tailed distribution diverge; only their quotients have limits.
  kDivergentLimit,
};

struct Direction {
  double theta_deg = 0.0;
  double cos_theta = 1.0;  ///< cosine of `used_deg`; for a mirror at 90 degrees a tiny positive number
  double used_deg = 0.0;   ///< zenith for the evaluator: `theta_deg`, or just below 90 degrees for a limit there
  Treatment treatment = Treatment::kIntegrated;
};

Treatment treatment_of(Distribution distribution, Masking masking, double theta_deg, const SlopeShape& shape);

Direction direction_of(Distribution distribution, Masking masking, double theta_deg, const SlopeShape& shape);

bool is_mirror(const SlopeShape& shape);

/// The zenith itself, or just below 90 degrees if it is 90 degrees and `masking` gives rho and f a limit there. Near 90
/// degrees rho and f differ from their limits in proportion to the cosine of the zenith.
double zenith_before_limit_deg(Masking masking, double zenith_deg);

}  // namespace dolp
