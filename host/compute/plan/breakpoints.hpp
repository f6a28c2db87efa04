// Slopes that divide the slope axis of a direction into pieces on which the integrand is smooth.
#pragma once

#include <vector>

#include "model/moments.hpp"
#include "plan/sky_table.hpp"

namespace dolp {

/// The largest slope of any integral. Squares of larger slopes overflow a float.
inline constexpr double kLargestCut = 1e15;

/// An end of a piece, with the flags kRootAbove and kRootBelow.
struct Breakpoint {
  double slope;
  unsigned roots;
  bool operator<(const Breakpoint& other) const { return slope < other.slope; }
};

/// The split lines of a direction that depend on the index or on the slope distribution.
struct DirectionVariant {
  double critical_cos = 0.0;  ///< cos(beta) at which total reflection begins; 0: there is none
  bool has_line = false;      ///< there is the line b = pi/2 of `integral`, or smith's cusp
};

/// The ascending slopes of a direction, starting with 0. With all bounces, the ends of the beams of up to `splits`
/// bounces split the azimuths.
std::vector<Breakpoint> breakpoints(double theta_deg, const MomentsRequest& request, const DirectionVariant& variant,
                                    const SkyTable& sky, int splits);

}  // namespace dolp
