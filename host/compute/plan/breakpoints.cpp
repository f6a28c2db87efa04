#include "plan/breakpoints.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "model/angles.hpp"
#include "plan/constants.hpp"
#include "plan/kernel_data.hpp"

namespace dolp {
namespace {

using std::numbers::pi;

constexpr unsigned kRoots = kRootAbove | kRootBelow;
constexpr double kNoEnd = 1e30;       // stands for an infinite slope; larger than every other breakpoint
constexpr double kCoincident = 1e-9;  // breakpoints within this relative distance differ only by rounding

constexpr std::size_t kMostBreakpoints = 60;  // a sky or measured reflectances add them until a direction has this many

// Long ranges of slopes, as in grazing directions, are also divided at these slopes.
constexpr std::array kPlainBreakpoints = {30.0, 3e5};
constexpr std::array kSteepBreakpoints = {1e5, 3e8, 1e12};  // in grooves, where all slopes reflect light

double tan_deg(double angle_deg) {
  const CosSin a = cos_sin_deg(angle_deg);
  return a.sin / a.cos;
}

// Total reflection begins at the line cos(beta) = critical. Adds the slopes at which this line meets another line that
// splits the azimuths (arcs.glsl).
void add_critical_breakpoints(std::vector<Breakpoint>& points, double theta_deg, const CosSin& a, Masking masking,
                              double critical) {
  const double critical_deg = std::acos(critical) * 180.0 / pi;
  points.push_back({tan_deg(std::abs(theta_deg - critical_deg)), kRoots});
  if (theta_deg + critical_deg < 90.0) points.push_back({tan_deg(theta_deg + critical_deg), kRoots});
  const auto add = [&](double facet_cos, double least_cos) {
    if (facet_cos <= least_cos || facet_cos >= 1.0) return;
    points.push_back({std::sqrt((1.0 - facet_cos) * (1.0 + facet_cos)) / facet_cos, kRoots});
  };
  add(a.cos / (2.0 * critical), 0.0);
  add(a.cos / critical, 0.0);
  if (masking != Masking::kVCavity || a.cos <= 0.0) return;
  const double at_slope_1 = std::sqrt(0.5);  // cos(alpha) at slope 1. If slope < 1, v-cavity masking adds two lines
  add(0.5 * critical / a.cos, at_slope_1);
  add(critical / (std::hypot(a.cos, 2.0 * critical) - a.cos), at_slope_1);
}

// Slopes at the kink of `integral` or smith masking. Used if needs_line() of rule.hpp is true for the shape.
void add_line_breakpoints(std::vector<Breakpoint>& points, double theta_deg, const CosSin& a, Masking masking) {
  if (masking == Masking::kSmith) {
    points.push_back({tan_deg(0.5 * theta_deg), kRoots});
    return;
  }
  if (theta_deg > 45.0) {
    points.push_back({a.cos > 0.0 ? tan_deg(2.0 * theta_deg - 90.0) : kNoEnd, kRoots});
  } else {
    points.push_back({tan_deg(30.0 - theta_deg * 2.0 / 3.0), kRootAbove});
  }
  points.push_back({a.cos > 0.0 ? tan_deg(30.0 + theta_deg * 2.0 / 3.0) : kNoEnd, kRootBelow});
}

void add_v_cavity_breakpoints(std::vector<Breakpoint>& points, double theta_deg, const CosSin& a) {
  points.push_back({tan_deg(30.0 - theta_deg / 3.0), kRootAbove});
  if (theta_deg < 45.0) {
    points.push_back({tan_deg(30.0 + theta_deg / 3.0), kRootBelow});
  } else {
    points.push_back({a.cos / a.sin, kRootAbove});
    points.push_back({1.0, 0});
    points.push_back({a.cos > 0.0 ? a.sin / a.cos : kNoEnd, kRootBelow});
  }
}

// Slopes at which total reflection begins for a bounce after the first, in the plane of incidence (phi = 0 or pi).
void add_critical_bounces(std::vector<Breakpoint>& points, double theta_deg, double critical) {
  const double critical_deg = std::asin(critical) * 180.0 / pi;
  for (int k = 2; k <= kCriticalBounces; ++k) {
    for (const double angle_deg : {critical_deg, 180.0 - critical_deg}) {
      for (const double turned_deg : {angle_deg - theta_deg, angle_deg + theta_deg}) {
        const double gamma_deg = turned_deg / (2.0 * k - 1.0);
        if (gamma_deg > 0.0 && gamma_deg < 90.0) points.push_back({tan_deg(90.0 - gamma_deg), kRoots});
      }
    }
  }
}

// The azimuths of grooves are split at the lines of groove_lines() (arcs.glsl). Most of these breakpoints are slopes at
// which two such lines meet, or one of them meets the plane of incidence.
void add_groove_breakpoints(std::vector<Breakpoint>& points, double theta_deg, int splits) {
  const auto add = [&](double gamma_deg, unsigned roots) {
    if (gamma_deg > 0.0 && gamma_deg <= 90.0) points.push_back({tan_deg(90.0 - gamma_deg), roots});
  };
  for (int j = 1; j <= splits + 1; ++j) {
    add((90.0 - theta_deg) / j, kRootBelow);
    if (j * theta_deg < 90.0 + theta_deg) add((90.0 + theta_deg) / j, kRootAbove);
    const double turns = 2.0 * j + 1.0;
    if (turns * theta_deg < 180.0 - theta_deg) add((180.0 - theta_deg) / turns, kRootBelow);
    if (turns * theta_deg < 180.0 + theta_deg) add((180.0 + theta_deg) / turns, kRootAbove);
    if (90.0 < (j + 1) * theta_deg) add(90.0 / (j + 1), 0);
  }
  add(theta_deg, kRootAbove);
  for (double bounces = 8.0; bounces < DOLP_MOST_BOUNCES; bounces *= 2.0) {
    if (bounces > splits + 2.0) points.push_back({slope_with_bounces(bounces), 0});
  }
  for (double bounces = DOLP_MOST_BOUNCES; bounces <= DOLP_LAST_BOUNCES; bounces *= kSteepStep) {
    points.push_back({slope_with_bounces(bounces), 0});
  }
  for (const double slope : kSteepBreakpoints) points.push_back({slope, 0});
}

std::vector<Breakpoint> without_coincident(const std::vector<Breakpoint>& points) {
  std::vector<Breakpoint> distinct;
  for (const Breakpoint& point : points) {
    const bool is_new = distinct.empty() || point.slope > distinct.back().slope * (1.0 + kCoincident);
    if (is_new) distinct.push_back(point);
    distinct.back().roots |= point.roots;
  }
  return distinct;
}

// Slopes at which the ray reflected in the plane of incidence points at a kink of the radiance of the sky.
void add_sky_breakpoints(std::vector<Breakpoint>& points, double theta_deg, const SkyTable& sky) {
  if (sky.has_cusp) points.push_back({tan_deg(0.5 * theta_deg), kRoots});
  for (const double corner_deg : sky.corners_deg) {
    if (points.size() + 2 > kMostBreakpoints) return;
    points.push_back({tan_deg(0.5 * std::abs(corner_deg - theta_deg)), kRootAbove});
    points.push_back({tan_deg(0.5 * (corner_deg + theta_deg)), kRootBelow});
  }
}

// Slopes at which a ray in the plane of incidence meets a kink of measured reflectances.
void add_row_breakpoints(std::vector<Breakpoint>& points, double theta_deg, std::span<const double> kinks_deg) {
  for (const double angle_deg : kinks_deg) {
    if (points.size() + 2 > kMostBreakpoints) return;
    points.push_back({tan_deg(std::abs(theta_deg - angle_deg)), kRoots});
    if (theta_deg + angle_deg < 90.0) points.push_back({tan_deg(theta_deg + angle_deg), kRoots});
  }
}

// Splits each piece once more. So the rules get other nodes, and the result can check a run without these splits.
void add_extra_splits(std::vector<Breakpoint>& points) {
  constexpr double kShare = 0.43;
  const std::size_t count = points.size();
  for (std::size_t i = 0; i + 1 < count && points.size() <= DOLP_MAX_PIECES; ++i) {
    const double start = std::asinh(points[i].slope);
    const double end = std::asinh(std::min(points[i + 1].slope, kLargestCut));
    if (end > start) points.push_back({std::sinh(start + kShare * (end - start)), 0});
  }
  std::sort(points.begin(), points.end());
}

}  // namespace

std::vector<Breakpoint> breakpoints(double theta_deg, const MomentsRequest& request, const DirectionVariant& variant,
                                    const SkyTable& sky, int splits) {
  const CosSin a = cos_sin_deg(theta_deg);
  const Masking masking = request.masking;
  const bool is_multiple = request.scattering == Scattering::kMultiple;
  const double horizon = a.cos > 0.0 ? (1.0 + a.sin) / a.cos : kNoEnd;
  // With direct emission the slopes have no upper end, because facets emit even if their reflected ray does not leave.
  const bool has_end = !is_multiple && !request.wants_direct;
  const double last = has_end ? horizon : kNoEnd;
  std::vector<Breakpoint> points;
  if (!has_end) points.push_back({last, 0});
  if (is_multiple) {
    add_groove_breakpoints(points, theta_deg, splits);
  } else {
    points.insert(points.end(), {{a.cos / (1.0 + a.sin), kRootAbove}, {horizon, kRootBelow}});
    if (request.wants_direct && a.sin > 0.0) points.push_back({a.cos / a.sin, kRootAbove});
    if (request.wants_direct && masking == Masking::kVCavity) points.push_back({std::sqrt(3.0), 0});
  }
  if (masking == Masking::kIntegral && a.cos > 0.0) points.push_back({a.sin / a.cos, kRootBelow});
  if (variant.has_line) add_line_breakpoints(points, theta_deg, a, masking);
  if (masking == Masking::kVCavity && !is_multiple) add_v_cavity_breakpoints(points, theta_deg, a);
  for (const double slope : kPlainBreakpoints) {
    if (!is_multiple && last > kLongWay * slope) points.push_back({slope, 0});
  }
  if (variant.critical_cos > 0.0) {
    add_critical_breakpoints(points, theta_deg, a, masking, variant.critical_cos);
    if (is_multiple) add_critical_bounces(points, theta_deg, variant.critical_cos);
  }
  add_row_breakpoints(points, theta_deg, variant.kinks_deg);
  add_sky_breakpoints(points, theta_deg, sky);
  std::erase_if(points, [&](const Breakpoint& point) { return point.slope <= 0.0 || point.slope > last; });
  // The cusp of smith masking lies at tan(theta/2), so at slope 0 if theta is 0.
  const bool cusp_at_0 = variant.has_line && masking == Masking::kSmith && a.sin == 0.0;
  points.push_back({0.0, cusp_at_0 ? kRootAbove : 0U});
  std::sort(points.begin(), points.end());
  points = without_coincident(points);
  if (request.has_extra_splits) add_extra_splits(points);
  return points;
}

}  // namespace dolp
