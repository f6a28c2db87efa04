#pragma once

#include "model/choices.hpp"
#include "model/slopes.hpp"

namespace dolp {

/// How the program obtains the moments of a direction and a slope distribution.
enum class Treatment {
  kIntegrated,  ///< an evaluator integrates them
  /// Moments of a smooth surface. Used if sigma is so small that the slope density overflows a float.
  kMirror,
  /// Moments of a heavy-tailed distribution at 90 degrees. They diverge; only quotients such as r_q / r_i have limits.
  kDivergentLimit,
};

struct Direction {
  double theta_deg = 0.0;
  double cos_theta = 1.0;  ///< cosine of `used_deg`; for a mirror at 90 degrees a tiny positive number
  double used_deg = 0.0;   ///< zenith for the evaluator: `theta_deg`, or slightly less (see zenith_before_limit_deg)
  Treatment treatment = Treatment::kIntegrated;
};

Treatment choose_treatment(Distribution distribution, Masking masking, double theta_deg, const SlopeShape& shape);

Direction make_direction(Distribution distribution, Masking masking, double theta_deg, const SlopeShape& shape);

bool is_mirror(const SlopeShape& shape);

/// With some maskings, reflectances are 0 / 0 at 90 degrees. Then a slightly smaller zenith replaces 90 degrees.
double zenith_before_limit_deg(Masking masking, double zenith_deg);

}  // namespace dolp
