#include "run/closed_forms.hpp"

#include "model/smooth_surface.hpp"
#include "run/grazing_limit.hpp"

namespace dolp {
namespace {

// A rough surface that counts as a mirror has facets that are steeper than this all the same; the error estimate then
// carries their share.
constexpr double kMirrorSlope = 1e-6;

double steep_share(const Surface& surface, const SlopeShape& shape) {
  const double share = steeper_share(surface.distribution, shape, kMirrorSlope);
  const bool has_tail = shape.sigma > 0.0 && surface.distribution == Distribution::kCauchy;
  return has_tail ? share + kMirrorSlope : share;
}

}  // namespace

Moments closed_form(const Surface& surface, const Direction& direction, const SlopeShape& shape,
                    const OpticalConstants& index) {
  if (direction.treatment == Treatment::kDivergentLimit) return grazing_limit_moments(index, shape.q);
  const double steep = steep_share(surface, shape) * direction.cos_theta;
  Moments moments = mirror_moments(index, direction.cos_theta);
  for (const auto& [value, error] : kMomentMembers) moments.*error += steep;
  return moments;
}

}  // namespace dolp
