// Decides how to compute the moments of one direction and one slope distribution.
#pragma once

#include "model/choices.hpp"
#include "model/slopes.hpp"

namespace dolp {

/// Method that gives the moments.
enum class Treatment {
  kIntegrated,      ///< an evaluator computes them
  kMirror,          ///< R at the direction itself: sigma is so small that the slopes' density overflows a float
  kDivergentLimit,  ///< at 90 degrees moments of a heavy tail diverge, and only their quotients have a limit
};

/// A direction with the treatment of its moments.
struct Direction {
  double theta_deg = 0.0;
  double cos_theta = 1.0;  ///< cosine for the moments: exact, except for limits at 90 degrees
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
