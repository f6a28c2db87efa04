#pragma once

#include <span>
#include <vector>

#include "model/moments.hpp"
#include "plan/sky_table.hpp"

namespace dolp {

inline constexpr double kLargestCut = 1e15;  // squares of larger slopes overflow a float

struct Breakpoint {
  double slope;
  unsigned roots;
  bool operator<(const Breakpoint& other) const { return slope < other.slope; }
};

/// Properties of an index and of a slope distribution that add breakpoints to a direction.
struct DirectionVariant {
  double critical_cos = 0.0;               ///< cos(beta) at which total reflection begins; 0 without it
  bool has_line = false;                   ///< true if slopes are split at a kink of the masking, see needs_line()
  std::span<const double> kinks_deg = {};  ///< RowKinks::split_deg
};

/// Ascending slopes, starting with 0, that divide the slope axis into pieces with a smooth integrand. In grooves, up to
/// `splits` bounces are considered.
std::vector<Breakpoint> breakpoints(double theta_deg, const MomentsRequest& request, const DirectionVariant& variant,
                                    const SkyTable& sky, int splits);

}  // namespace dolp
