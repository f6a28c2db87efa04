#include "model/direction.hpp"

#include "model/angles.hpp"

namespace dolp {
namespace {

constexpr double kNearGrazingDeg = 90.0 - 1e-12;

// Replaces the cosine 0 of a mirror at 90 degrees, so that moments / cosine is not 0 / 0, but the limit at 90 degrees.
constexpr double kNearGrazingCosine = 1e-100;

constexpr double kSmallestSigma = 1e-28;
constexpr double kDivergentQ = 1.5;

}  // namespace

bool is_mirror(const SlopeShape& shape) { return shape.sigma < kSmallestSigma; }

double zenith_before_limit_deg(Masking masking, double zenith_deg) {
  return keeps_projected_area(masking) && zenith_deg == 90.0 ? kNearGrazingDeg : zenith_deg;
}

Treatment choose_treatment(Distribution distribution, Masking masking, double theta_deg, const SlopeShape& shape) {
  if (is_mirror(shape)) return Treatment::kMirror;
  const bool has_heavy_tail = distribution == Distribution::kCauchy && shape.q <= kDivergentQ;
  const bool diverges = theta_deg == 90.0 && has_heavy_tail && !keeps_projected_area(masking);
  return diverges ? Treatment::kDivergentLimit : Treatment::kIntegrated;
}

Direction make_direction(Distribution distribution, Masking masking, double theta_deg, const SlopeShape& shape) {
  Direction direction;
  direction.theta_deg = theta_deg;
  direction.treatment = choose_treatment(distribution, masking, theta_deg, shape);
  const bool is_integrated = direction.treatment == Treatment::kIntegrated;
  direction.used_deg = is_integrated ? zenith_before_limit_deg(masking, theta_deg) : theta_deg;
  const bool is_mirror_limit = direction.treatment == Treatment::kMirror && theta_deg == 90.0;
  direction.cos_theta = is_mirror_limit ? kNearGrazingCosine : cos_sin_deg(direction.used_deg).cos;
  return direction;
}

}  // namespace dolp
