#include "plan/facet_bounds.hpp"

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/numbers.hpp"
#include "model/angles.hpp"
#include "model/gamma_ratio.hpp"
#include "model/scattering.hpp"
#include "model/smooth_surface.hpp"
#include "plan/geometry.hpp"

namespace dolp {
namespace {

using std::numbers::pi;

// Shells of slopes: the first ends at this share of the width, the last but one where so few facets are left.
constexpr std::size_t kMostShells = 40;
constexpr std::size_t kFewShells = 6;
constexpr double kFirstShell = 0.125;
constexpr double kLeftOver = 1e-12;
constexpr double kWidest = 1e8;  // in widths

// Of 1 - absorptance, and of the sums of positive terms.
constexpr double kFacetRounding = 1e-13;

bool keeps_energy(Masking masking) { return masking == Masking::kVCavity || masking == Masking::kSmith; }

/// The slope, in widths, beyond which kLeftOver of the facets lies.
double reach(Distribution distribution, const SlopeShape& shape) {
  if (distribution == Distribution::kGaussian) return std::sqrt(-std::log(kLeftOver));
  return std::min(kWidest, power_law_reach(kLeftOver, shape.q - 1.0));
}

/// R_s of the best reflecting index, a bound of its rounding included.
double most_r_s(std::span<const OpticalConstants> indices, double cosine) {
  double most = 0.0;
  if (cosine <= 0.0) return 1.0;
  for (const OpticalConstants& index : indices) most = std::max(most, 1.0 - smooth_absorptance(index, cosine).s);
  return std::clamp(most + kFacetRounding * (most > 0.0 ? 1.0 : 0.0), 0.0, 1.0);
}

/// Azimuthal mean of max(e, 0).
double mean_projection(const CosSin& a, double slope) {
  const double st = a.sin * slope;
  if (st <= a.cos) return a.cos;
  const double z = a.cos / st;
  return (a.cos * std::acos(-z) + st * std::sqrt((1.0 - z) * (1.0 + z))) / pi;
}

struct Shell {
  double albedo = 0.0;  ///< most of the albedo integral times cos(theta)
  double r_s = 0.0;     ///< most of R_s
};

boost::container::static_vector<Shell, kMostShells> shells_of(std::size_t count, const Surface& surface,
                                                              const CosSin& a, const SlopeShape& shape,
                                                              std::span<const OpticalConstants> indices) {
  const double horizon = (1.0 + a.sin) / a.cos;
  const double w = slope_width(shape);
  const double first = std::min(kFirstShell * w, horizon);
  const double last = std::clamp(reach(surface.distribution, shape) * w, first, horizon);
  const double ratio = first > 0.0 ? std::pow(last / first, 1.0 / static_cast<double>(count - 2)) : 1.0;
  boost::container::static_vector<Shell, kMostShells> shells(count);
  double from = 0.0;
  double left = 1.0;
  for (std::size_t k = 0; k < count; ++k) {
    const double to = k + 1 == count ? horizon : std::min(first * std::pow(ratio, static_cast<double>(k)), horizon);
    const double left_after = steeper_share(surface.distribution, shape, to);
    double projection = mean_projection(a, to);
    if (surface.masking == Masking::kVCavity) projection = std::min(projection, 2.0 * a.cos);
    const double low_facet = (a.cos - a.sin * to) / std::hypot(1.0, to);
    const double leaving = 0.5 * a.cos * std::hypot(1.0, from);
    shells[k].albedo = std::max(left - left_after, 0.0) * projection * (1.0 + kFacetRounding) + kFacetRounding * a.cos;
    shells[k].r_s = most_r_s(indices, std::clamp(std::max(low_facet, leaving), 0.0, 1.0));
    from = to;
    left = left_after;
  }
  return shells;
}

double mean_slope(Distribution distribution, const SlopeShape& shape) {
  const double w = slope_width(shape) / kRootPi;
  if (distribution == Distribution::kGaussian) return w;
  return shape.q > 1.5 ? w / gamma_ratio(shape.q - 1.5) : kInfinity;
}

/// Most of smith's L at a direction.
double most_lambda(Distribution distribution, const SlopeShape& shape, const CosSin& a) {
  if (shape.sigma == 0.0 || a.sin == 0.0) return 0.0;
  return a.cos > 0.0 ? 0.5 * mean_slope(distribution, shape) * a.sin / a.cos : kInfinity;
}

double least_normal_reflectance(std::span<const OpticalConstants> indices) {
  double least = 1.0;
  for (const OpticalConstants& index : indices) {
    const double k2 = index.k * index.k;
    least = std::min(least, ((index.n - 1.0) * (index.n - 1.0) + k2) / ((index.n + 1.0) * (index.n + 1.0) + k2));
  }
  return least;
}

/// Least of the albedo integral over the facets up to `slope`, for an azimuthal mean of e G.
double least_projection(const Surface& surface, const CosSin& a, const SlopeShape& shape, double slope) {
  const double lowest = a.cos - a.sin * slope;
  const double cos_r = 2.0 * lowest / (1.0 + slope * slope) - a.cos;
  switch (surface.masking) {
    case Masking::kNone:
      return a.cos;
    case Masking::kIntegral:
      return 0.5 * a.cos;
    case Masking::kVCavity:
      return std::max(0.0, std::min({lowest, 2.0 * a.cos, 2.0 * cos_r}));
    case Masking::kSmith: {
      if (cos_r <= 0.0) return 0.0;
      const CosSin reflected{cos_r, std::sqrt(std::max(0.0, (1.0 - cos_r) * (1.0 + cos_r)))};
      const double lambdas =
          most_lambda(surface.distribution, shape, a) + most_lambda(surface.distribution, shape, reflected);
      return a.cos / (1.0 + lambdas);
    }
  }
  return 0.0;
}

double least_albedo(const Surface& surface, const CosSin& a, const SlopeShape& shape) {
  constexpr std::array kShares = {0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 0.95};
  const double edge = a.cos / (1.0 + a.sin);
  double least = 0.0;
  for (const double share : kShares) {
    const double facets = 1.0 - steeper_share(surface.distribution, shape, share * edge);
    least = std::max(least, facets * least_projection(surface, a, shape, share * edge));
  }
  return least * (1.0 - kFacetRounding);
}

}  // namespace

ReflectanceBounds reflectance_bounds(const Surface& surface, double theta_deg, const SlopeShape& shape,
                                     std::span<const OpticalConstants> indices, Detail detail) {
  const CosSin a = cos_sin_deg(theta_deg);
  const bool conserves = keeps_energy(surface.masking);
  if (a.cos == 0.0) {
    double most = kInfinity;
    if (conserves) most = 1.0;
    return {most, 0.5 * most, 0.0};
  }
  auto shells = shells_of(detail == Detail::kFine ? kMostShells : kFewShells, surface, a, shape, indices);
  std::ranges::sort(shells, std::ranges::greater{}, &Shell::r_s);
  double room = kInfinity;
  if (conserves) room = a.cos;
  double reflected = 0.0;
  ReflectanceBounds bounds;
  for (const Shell& shell : shells) {
    const double albedo = std::min(shell.albedo, room);
    room -= albedo;
    reflected += albedo * shell.r_s / a.cos;
  }
  bounds.most_i = reflected * (1.0 + kFacetRounding);
  if (conserves) bounds.most_i = std::min(bounds.most_i, 1.0);
  bounds.most_q = 0.5 * bounds.most_i;
  bounds.least_i = 0.5 * least_normal_reflectance(indices) * least_albedo(surface, a, shape) / a.cos;
  return bounds;
}

ReflectanceBounds coarse_reflectance_bounds(const Surface& surface, double theta_deg, const SlopeShape& shape) {
  const double excess =
      keeps_energy(surface.masking) ? 0.0 : most_lambda(surface.distribution, shape, cos_sin_deg(theta_deg));
  return {(1.0 + excess) * (1.0 + kFacetRounding), 0.5 * (1.0 + excess) * (1.0 + kFacetRounding), 0.0};
}

BeamBounds beam_bounds(const Surface& surface, double theta_i_deg, double theta_r_deg, double delta_phi_deg,
                       const SlopeShape& shape, std::span<const OpticalConstants> indices) {
  const BeamAngles angles{theta_i_deg, theta_r_deg, delta_phi_deg};
  const bool is_mirror = shape.sigma == 0.0;
  if (!has_facet(angles) || (is_mirror && is_specular(angles))) return {kInfinity, 0.0, kInfinity};
  if (is_mirror) return {};
  const kernel::GeometryNode g = geometry_node(theta_i_deg, theta_r_deg, delta_phi_deg);
  const double w = slope_width(shape);
  const double sec2 = 1.0 + g.slope * g.slope;
  const double u2 = g.slope * g.slope / (w * w);
  const double profile = surface.distribution == Distribution::kGaussian
                             ? std::exp(-u2)
                             : (shape.q - 1.0) * std::exp(-shape.q * std::log1p(u2));
  const double scale = 0.25 * profile * sec2 * sec2 / (pi * w * w);
  double least_g = 1.0;
  double most_g = 1.0;
  const double lower_cos = std::min(g.c_i, g.c_r);
  if (surface.masking == Masking::kIntegral) least_g = 0.5;
  if (surface.masking == Masking::kVCavity) {
    least_g = most_g = std::min(1.0, 2.0 * lower_cos / (std::sqrt(sec2) * g.cos_beta));
  }
  if (surface.masking == Masking::kSmith) {
    least_g = 1.0 / (1.0 + most_lambda(surface.distribution, shape, {g.c_i, g.s_i}) +
                     most_lambda(surface.distribution, shape, {g.c_r, g.s_r}));
  }
  BeamBounds bounds;
  double least = kInfinity;
  for (const OpticalConstants& index : indices) {
    const SmoothAbsorptance absorbed = smooth_absorptance(index, std::max(g.cos_beta, 1e-300));
    const double mean = std::max(0.0, 1.0 - 0.5 * (absorbed.s + absorbed.p));
    bounds.most_i = std::max(bounds.most_i, scale * most_g * (mean + kFacetRounding));
    bounds.most_qu =
        std::max(bounds.most_qu, scale * most_g * (0.5 * std::abs(absorbed.p - absorbed.s) + kFacetRounding));
    least = std::min(least, scale * least_g * std::max(0.0, mean - kFacetRounding));
  }
  bounds.least_i = least;
  return bounds;
}

}  // namespace dolp
