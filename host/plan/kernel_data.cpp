#include "plan/kernel_data.hpp"

#include <algorithm>
#include <array>
#include <boost/math/constants/constants.hpp>
#include <boost/math/special_functions/cos_pi.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <boost/math/special_functions/sin_pi.hpp>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "plan/rule_nodes.hpp"

namespace dolp {
namespace {

using boost::math::constants::pi;
using boost::math::constants::root_pi;

constexpr double kEndAbove = 1.0;  // square-root end just above a breakpoint
constexpr double kEndBelow = 2.0;  // just below
constexpr double kNoEnd = 1e30;    // a slope beyond every cut, in place of infinity

// The orders follow a scan of the domain for entries whose estimate misses the tolerance: about 2.4 slopes and one
// azimuth of an arc for each digit (tests/plan_test.cpp repeats the scan on a sample).
// The rule aims this many digits beyond the tolerance, so that the coarser rule it is compared with meets the
// tolerance.
constexpr double kExtraDigits = 2.0;

// Im N^2 above which absorption has smoothed the critical line of total reflection.
constexpr double kSoftCriticalLine = 0.3;

// The square root of total reflection wants more nodes.
constexpr double kTotalReflectionOrderT = 1.4;
constexpr double kTotalReflectionOrderPhi = 2.0;

// Azimuths for a digit with smith masking, which is not smooth at theta_r = 0.
constexpr double kSmithOrderPhi = 2.4;

// Bound of the loop iterations of one invocation, below the 65,535 at which lavapipe stops without notice.
constexpr double kMostIterations = 60'000.0;

// Largest slope that is ever integrated: beyond it the squares of a float overflow.
constexpr double kLargestCut = 1e15;

// Slopes that only split the long way to the horizon of a grazing direction, where a heavy tail reaches far, into
// pieces of ten units of X or so.
constexpr std::array kPlainBreakpoints = {30.0, 3e5};
constexpr double kLongWay = 300.0;  // from a plain breakpoint to a horizon that is worth one, as a factor

// Scale of the masking table, the width of the slope distribution if it can be. The end of the table, 5e8 scales away,
// must lie far beyond slope 1, where p is a power law, unless the tail there is nothing (q >= kLightTailQ).
constexpr double kSmallestHeavyTableScale = 1e-4;
constexpr double kLightTailQ = 1.5;
constexpr double kLargestTableScale = 0.5;

struct Breakpoint {
  double slope;
  double kind;
};

double tan_deg(double angle_deg) {
  const CosSin a = cos_sin_deg(angle_deg);
  return a.sin / a.cos;
}

// cos(beta) at which w vanishes, sqrt(1 - Re N^2), where that is a kink (k = 0) or nearly one; 0 elsewhere.
double critical_cos(const OpticalConstants& index) {
  const double squared = (1.0 - index.n) * (1.0 + index.n) + index.k * index.k;
  const bool is_sharp = 2.0 * index.n * index.k < kSoftCriticalLine;
  return is_sharp && squared > 0.0 && squared < 1.0 ? std::sqrt(squared) : 0.0;
}

// Slopes at which the critical line cos(beta) = critical_cos meets phi = 0 or pi, the horizon or theta_r = theta.
void add_critical_breakpoints(std::vector<Breakpoint>& points, double theta_deg, const CosSin& a, double critical) {
  const double critical_deg = std::acos(critical) * 180.0 / pi<double>();
  points.push_back({tan_deg(std::abs(theta_deg - critical_deg)), kEndAbove + kEndBelow});
  if (theta_deg + critical_deg < 90.0) points.push_back({tan_deg(theta_deg + critical_deg), kEndAbove + kEndBelow});
  for (const double facet_cos : {a.cos / (2.0 * critical), a.cos / critical}) {
    if (facet_cos <= 0.0 || facet_cos >= 1.0) continue;
    points.push_back({std::sqrt((1.0 - facet_cos) * (1.0 + facet_cos)) / facet_cos, kEndAbove + kEndBelow});
  }
}

// Slopes at which the set of smooth arcs changes: where a split line of the azimuth (integrand.glsl) meets phi = 0 or
// pi or another line. The horizon does at t1 = c / (1 + s) and t2 = (1 + s) / c, theta_r = theta at tan(theta), the
// limit b = pi/2 at tan(30 -+ 2/3 theta) and, on theta_r = theta, at tan(2 theta - 90); the lines of v-cavity at tan(30
// -+ theta/3), cot(theta), 1 and tan(theta); smith's cusp is at tan(theta/2).
std::vector<Breakpoint> breakpoints(double theta_deg, const CosSin& a, Masking masking, double critical) {
  const double horizon = a.cos > 0.0 ? (1.0 + a.sin) / a.cos : kNoEnd;
  std::vector<Breakpoint> points = {{a.cos / (1.0 + a.sin), kEndAbove}, {horizon, kEndBelow}};
  if (masking == Masking::kIntegral) {
    if (a.cos > 0.0) points.push_back({a.sin / a.cos, kEndBelow});
    if (theta_deg > 45.0) {
      points.push_back({a.cos > 0.0 ? tan_deg(2.0 * theta_deg - 90.0) : kNoEnd, kEndAbove + kEndBelow});
    } else {
      points.push_back({tan_deg(30.0 - theta_deg * 2.0 / 3.0), kEndAbove});
    }
    points.push_back({a.cos > 0.0 ? tan_deg(30.0 + theta_deg * 2.0 / 3.0) : kNoEnd, kEndBelow});
  }
  if (masking == Masking::kSmith) points.push_back({tan_deg(0.5 * theta_deg), kEndAbove + kEndBelow});
  if (masking == Masking::kVCavity) {
    points.push_back({tan_deg(30.0 - theta_deg / 3.0), kEndAbove});
    if (theta_deg < 45.0) {
      points.push_back({tan_deg(30.0 + theta_deg / 3.0), kEndBelow});
    } else {
      points.push_back({a.cos / a.sin, kEndAbove});
      points.push_back({1.0, 0.0});
      points.push_back({a.cos > 0.0 ? a.sin / a.cos : kNoEnd, kEndBelow});
    }
  }
  for (const double slope : kPlainBreakpoints) {
    if (horizon > kLongWay * slope) points.push_back({slope, 0.0});
  }
  if (critical > 0.0) add_critical_breakpoints(points, theta_deg, a, critical);
  std::sort(points.begin(), points.end(), [](const auto& x, const auto& y) { return x.slope < y.slope; });
  return points;
}

// Bound of the loop iterations of one invocation for a direction whose slopes have `arcs` arcs each: pieces, slopes,
// arcs, azimuths, for the fine and the coarse rule, with every piece at its most nodes.
double iterations(const kernel::ThetaNode& node, double arcs) {
  const double coarse_t = 0.25 * (3.0 * node.order_limit + 1.0);
  const double coarse_phi = 0.75 * node.order_phi;
  return node.piece_count * (1.0 + (1.0 + arcs) * (node.order_limit + coarse_t) +
                             arcs * (node.order_limit * node.order_phi + coarse_t * coarse_phi));
}

double arcs_per_slope(Masking masking, double critical) {
  const double zones = masking == Masking::kIntegral || masking == Masking::kVCavity ? 3.0 : 1.0;
  return critical > 0.0 ? 2.0 * zones : zones;
}

// Limits the orders so that the kernel is sure to finish; the error estimate then shows what that costs.
void limit_iterations(kernel::ThetaNode& node, double arcs) {
  node.order_phi = std::min<double>(node.order_phi, DOLP_MAX_ORDER);
  node.order_limit = DOLP_MAX_ORDER;
  while (iterations(node, arcs) > kMostIterations) node.order_limit -= 1.0;
}

kernel::ThetaNode theta_node(const MomentsRequest& request, double theta_deg, double digits, double critical) {
  const CosSin a = cos_sin_deg(theta_deg);
  kernel::ThetaNode node{};
  node.c = a.cos;
  node.s = a.sin;
  const double horizon = a.cos > 0.0 ? (1.0 + a.sin) / a.cos : kNoEnd;
  int pieces = 0;
  for (const Breakpoint& point : breakpoints(theta_deg, a, request.masking, critical)) {
    if (point.slope <= 0.0 || point.slope > horizon) continue;
    ++pieces;
    assert(pieces <= DOLP_MAX_PIECES);
    node.end[pieces] = point.slope;
    node.kind[pieces] = point.kind;
  }
  node.piece_count = pieces;
  // Toward grazing incidence the pseudo-Brewster structure asks for slopes, the horizon for azimuths.
  const double oblique = std::clamp((theta_deg - 65.0) / 15.0, 0.0, 1.0);
  node.order_t = digits * (2.4 + 0.9 * oblique) + 2.5;
  node.order_per_e = node.order_t / (digits * std::log(10.0));
  const double grazing = std::clamp((theta_deg - 80.0) / 9.0, 0.0, 1.0);
  const double smooth = 0.2 + digits * (0.97 + 0.6 * grazing * grazing + 0.3 * std::max(0.0, theta_deg - 88.0));
  node.order_phi = std::ceil(request.masking == Masking::kSmith ? std::max(smooth, kSmithOrderPhi * digits) : smooth);
  if (critical > 0.0) {
    node.order_t *= kTotalReflectionOrderT;
    node.order_phi = std::ceil(kTotalReflectionOrderPhi * node.order_phi);
  }
  limit_iterations(node, arcs_per_slope(request.masking, critical));
  return node;
}

// Slope beyond which less than `share` of the facets' weight lies, weighted by 1 and by slope.
double slope_cut(const MomentsRequest& request, const SlopeShape& shape, double share) {
  const double m = std::sqrt(2.0) * shape.sigma;
  if (request.distribution == Distribution::kGaussian) return m * std::sqrt(1.0 - std::log(share));
  const double exponent = shape.q - 1.5;
  if (exponent <= 0.0) return kLargestCut;
  return std::min(kLargestCut, m * std::sqrt(std::expm1(std::min(-std::log(share) / exponent, 500.0))));
}

kernel::ShapeNode shape_node(const MomentsRequest& request, const SlopeShape& shape) {
  kernel::ShapeNode node{};
  node.m = std::sqrt(2.0) * shape.sigma;
  node.q_minus_1 = shape.q - 1.0;
  const bool cauchy = request.distribution == Distribution::kCauchy;
  node.marginal_norm =
      (cauchy ? boost::math::tgamma_ratio(shape.q - 0.5, shape.q - 1.0) : 1.0) / (root_pi<double>() * node.m);
  node.two_q_minus_3 = 2.0 * shape.q - 3.0;
  node.scale = std::min(cauchy ? node.m / std::sqrt(std::max(1.0, 0.25 * shape.q)) : node.m, 1.0);
  node.cut = slope_cut(request, shape, 1e-3 * request.tolerance);
  const double width = cauchy ? node.m / std::sqrt(std::max(1.0, shape.q / 1.5)) : node.m;
  const bool heavy_tail = cauchy && shape.q < kLightTailQ;
  node.table_scale = std::clamp(width, heavy_tail ? kSmallestHeavyTableScale : 0.0, kLargestTableScale);
  return node;
}

kernel::IndexNode index_node(const OpticalConstants& index) {
  return {(index.n - 1.0) * (index.n + 1.0) - index.k * index.k, 2.0 * index.n * index.k, critical_cos(index)};
}

// Gives the entries under total reflection directions with their own pieces.
void add_total_reflection(KernelData& data, const MomentsRequest& request, double digits) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> nodes;
  for (MomentsEntry& entry : data.entries) {
    const double critical = data.indices[entry.index].critical_cos;
    if (critical <= 0.0) continue;
    const auto [found, is_new] =
        nodes.try_emplace({entry.theta, entry.index}, static_cast<std::uint32_t>(data.thetas.size()));
    if (is_new) data.thetas.push_back(theta_node(request, request.theta_deg[entry.theta], digits, critical));
    entry.theta = found->second;
  }
}

}  // namespace

CosSin cos_sin_deg(double angle_deg) {
  return {boost::math::cos_pi(angle_deg / 180.0), boost::math::sin_pi(angle_deg / 180.0)};
}

KernelData kernel_data(const MomentsRequest& request) {
  const double digits = kExtraDigits - std::log10(request.tolerance);
  KernelData data;
  data.distribution = request.distribution;
  data.masking = request.masking;
  data.tolerance = request.tolerance;
  data.rule_nodes = rule_nodes();
  for (const double theta_deg : request.theta_deg) data.thetas.push_back(theta_node(request, theta_deg, digits, 0.0));
  for (const SlopeShape& shape : request.shapes) data.shapes.push_back(shape_node(request, shape));
  for (const OpticalConstants& index : request.indices) data.indices.push_back(index_node(index));
  data.entries = request.entries;
  add_total_reflection(data, request, digits);
  return data;
}

double worst_iterations(const KernelData& data) {
  double worst = 0.0;
  for (const MomentsEntry& entry : data.entries) {
    const double arcs = arcs_per_slope(data.masking, data.indices[entry.index].critical_cos);
    worst = std::max(worst, iterations(data.thetas[entry.theta], arcs));
  }
  return worst;
}

}  // namespace dolp
