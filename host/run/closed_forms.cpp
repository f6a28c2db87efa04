#include "run/closed_forms.hpp"

#include <cmath>

#include "model/angles.hpp"
#include "model/smooth_surface.hpp"
#include "run/grazing_limit.hpp"

namespace dolp {
namespace {

// Below this roughness the slopes' density overflows a float; the surface is a mirror but for the share of the facets
// that are steeper than kMirrorSlope all the same, which the error estimate then carries.
constexpr double kSmallestSigma = 1e-28;
constexpr double kMirrorSlope = 1e-6;

// Stands for the cosine of 90 degrees in the closed form of a mirror: small beside the inverse square of any index.
constexpr double kNearGrazingCosine = 1e-100;

double steep_share(const Scene& scene, const SlopeShape& shape) {
  const double share = steeper_share(scene.surface.distribution, shape, kMirrorSlope);
  const bool has_tail = shape.sigma > 0.0 && scene.surface.distribution == Distribution::kCauchy;
  return has_tail ? share + kMirrorSlope : share;
}

/// At 90 degrees the moments of a heavy tail diverge, and only their quotients have a limit.
bool is_divergent(const Scene& scene, const SceneEntry& entry) {
  const Masking masking = scene.surface.masking;
  return entry.theta_deg == 90.0 && (masking == Masking::kNone || masking == Masking::kIntegral) &&
         scene.surface.distribution == Distribution::kCauchy && entry.shape.q <= 1.5;
}

Moments mirror_with_bound(const Scene& scene, const SceneEntry& entry, const OpticalConstants& index) {
  const double cosine = closed_form_cosine(entry);
  const double steep = steep_share(scene, entry.shape) * cosine;
  Moments moments = mirror_moments(index, cosine);
  for (double* error : {&moments.r_i_error, &moments.r_q_error, &moments.albedo_error, &moments.deficit_error}) {
    *error += steep;
  }
  return moments;
}

}  // namespace

bool is_mirror(const SlopeShape& shape) { return shape.sigma < kSmallestSigma; }

bool needs_evaluator(const Scene& scene, const SceneEntry& entry) {
  return !is_mirror(entry.shape) && !is_divergent(scene, entry);
}

double closed_form_cosine(const SceneEntry& entry) {
  const bool has_limit = is_mirror(entry.shape) && entry.theta_deg == 90.0;
  return has_limit ? kNearGrazingCosine : cos_sin_deg(entry.theta_deg).cos;
}

std::vector<Moments> closed_forms(const Scene& scene, const SceneEntry& entry,
                                  const std::vector<OpticalConstants>& indices) {
  std::vector<Moments> moments;
  for (const OpticalConstants& index : indices) {
    moments.push_back(is_mirror(entry.shape) ? mirror_with_bound(scene, entry, index)
                                             : grazing_limit_moments(index, entry.shape.q));
  }
  return moments;
}

}  // namespace dolp
