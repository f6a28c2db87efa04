// Slopes that divide the slope axis of a direction into pieces on which the integrand is smooth.
#pragma once

#include <vector>

#include "model/moments.hpp"
#include "plan/sky_table.hpp"

namespace dolp {

/// The largest slope of all integrals: beyond it the squares of a float overflow.
inline constexpr double kLargestCut = 1e15;

/// An end of a piece, with the flags kRootAbove and kRootBelow.
struct Breakpoint {
  double slope;
  unsigned roots;
  bool operator<(const Breakpoint& other) const { return slope < other.slope; }
};

/// The lines of a direction that do not belong to its masking.
struct DirectionVariant {
  double critical_cos = 0.0;  ///< cos(beta) at which total reflection begins; 0: there is none
  bool has_line = false;      ///< b = pi/2 of `integral`, or smith's cusp
};

/// Ascending slopes, starting with 0. `splits`: bounces in a groove at which a beam that ends splits the azimuths.
std::vector<Breakpoint> breakpoints(double theta_deg, const MomentsRequest& request, const DirectionVariant& variant,
                                    const SkyTable& sky, int splits);

}  // namespace dolp
