// What stands for 90 degrees where rho or f has a limit there.
#pragma once

#include "model/choices.hpp"

namespace dolp {

/// rho and f of a rough surface approach their limits like the cosine.
inline constexpr double kNearGrazingDeg = 90.0 - 1e-12;

/// Whether rho and f of the specular part have a limit at 90 degrees.
inline bool has_grazing_limit(Masking masking) { return masking == Masking::kVCavity || masking == Masking::kSmith; }

/// The zenith itself, or just before 90 degrees for a limit there.
inline double zenith_before_limit_deg(Masking masking, double zenith_deg) {
  return has_grazing_limit(masking) && zenith_deg == 90.0 ? kNearGrazingDeg : zenith_deg;
}

}  // namespace dolp
