#include "plan/kernel_data.hpp"

#include <algorithm>
#include <array>
#include <boost/math/constants/constants.hpp>
#include <cassert>
#include <cmath>
#include <compare>
#include <complex>
#include <limits>
#include <map>
#include <utility>

#include "model/angles.hpp"
#include "model/gamma_ratio.hpp"
#include "plan/rule.hpp"
#include "plan/rule_nodes.hpp"

namespace dolp {
namespace {

using boost::math::constants::pi;
using boost::math::constants::root_pi;

constexpr double kEndAbove = 1.0;  // square-root end just above a breakpoint
constexpr double kEndBelow = 2.0;  // just below
constexpr double kNoEnd = 1e30;    // a slope beyond every cut, in place of infinity

// Breakpoints nearer to each other than this share of the piece beyond, in ln(slope): the square root of the one is
// felt beyond the other.
constexpr double kNear = 0.25;
constexpr double kFirst = 2.0;  // what the piece from 0 counts as

// Share of the tolerance that the slopes beyond the cut may carry.
constexpr double kCutShare = 0.03;

// Im N^2 above which absorption has smoothed the critical line of total reflection.
constexpr double kSoftCriticalLine = 0.3;

// The square root of total reflection wants more nodes.
constexpr double kTotalReflectionGrowthT = 1.4;
constexpr double kTotalReflectionNarrowing = 1.5;

constexpr double kSmallestPole = 1e-6;  // of |N^2 + 1| and |N^2 - 1|

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
  double kind;  // sum of the ends
  bool operator<(const Breakpoint& other) const { return slope < other.slope; }
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

// Slopes at which the line b = pi/2 of `integral` meets phi = 0 or pi, and theta_r = theta; or smith's cusp.
void add_line_breakpoints(std::vector<Breakpoint>& points, double theta_deg, const CosSin& a, Masking masking) {
  if (masking == Masking::kSmith) {
    points.push_back({tan_deg(0.5 * theta_deg), kEndAbove + kEndBelow});
    return;
  }
  if (theta_deg > 45.0) {
    points.push_back({a.cos > 0.0 ? tan_deg(2.0 * theta_deg - 90.0) : kNoEnd, kEndAbove + kEndBelow});
  } else {
    points.push_back({tan_deg(30.0 - theta_deg * 2.0 / 3.0), kEndAbove});
  }
  points.push_back({a.cos > 0.0 ? tan_deg(30.0 + theta_deg * 2.0 / 3.0) : kNoEnd, kEndBelow});
}

void add_v_cavity_breakpoints(std::vector<Breakpoint>& points, double theta_deg, const CosSin& a) {
  points.push_back({tan_deg(30.0 - theta_deg / 3.0), kEndAbove});
  if (theta_deg < 45.0) {
    points.push_back({tan_deg(30.0 + theta_deg / 3.0), kEndBelow});
  } else {
    points.push_back({a.cos / a.sin, kEndAbove});
    points.push_back({1.0, 0.0});
    points.push_back({a.cos > 0.0 ? a.sin / a.cos : kNoEnd, kEndBelow});
  }
}

bool has_end(const Breakpoint& point, double end) {
  return end == kEndBelow ? point.kind > 1.5 : std::fmod(point.kind, 2.0) > 0.5;
}

// A breakpoint next to one with a square root, seen from the piece beyond, gets one too.
void spread_roots(std::vector<Breakpoint>& points) {
  const std::vector<Breakpoint> own = points;
  const auto log_slope = [&](std::size_t i) {
    return i > 0 ? std::log(own[i].slope) : std::log(own[1].slope) - kFirst;
  };
  const auto distance = [&](std::size_t i, std::size_t j) { return std::abs(log_slope(i) - log_slope(j)); };
  for (std::size_t j = 1; j + 1 < own.size(); ++j) {
    for (std::size_t i = 1; i < own.size(); ++i) {
      const double end = i < j ? kEndAbove : kEndBelow;
      const std::size_t beyond = i < j ? j + 1 : j - 1;
      const bool is_near = i != j && distance(i, j) < kNear * distance(j, beyond);
      if (is_near && has_end(own[i], end) && !has_end(points[j], end)) points[j].kind += end;
    }
  }
}

// What makes a direction's pieces, beside the masking.
struct Variant {
  double critical_cos = 0.0;
  bool has_line = false;
  auto operator<=>(const Variant&) const = default;
};

// Slopes from 0 on at which the set of smooth arcs changes: where a split line of the azimuth (integrand.glsl) meets
// phi = 0 or pi or another line. The horizon does at t1 = c / (1 + s) and t2 = (1 + s) / c, theta_r = theta at
// tan(theta), the limit b = pi/2 at tan(30 -+ 2/3 theta) and, on theta_r = theta, at tan(2 theta - 90); the lines of
// v-cavity at tan(30 -+ theta/3), cot(theta), 1 and tan(theta); smith's cusp is at tan(theta/2).
std::vector<Breakpoint> breakpoints(double theta_deg, const CosSin& a, Masking masking, const Variant& variant) {
  const double horizon = a.cos > 0.0 ? (1.0 + a.sin) / a.cos : kNoEnd;
  std::vector<Breakpoint> points = {{a.cos / (1.0 + a.sin), kEndAbove}, {horizon, kEndBelow}};
  if (masking == Masking::kIntegral && a.cos > 0.0) points.push_back({a.sin / a.cos, kEndBelow});
  if (variant.has_line) add_line_breakpoints(points, theta_deg, a, masking);
  if (masking == Masking::kVCavity) add_v_cavity_breakpoints(points, theta_deg, a);
  for (const double slope : kPlainBreakpoints) {
    if (horizon > kLongWay * slope) points.push_back({slope, 0.0});
  }
  if (variant.critical_cos > 0.0) add_critical_breakpoints(points, theta_deg, a, variant.critical_cos);
  std::erase_if(points, [&](const Breakpoint& point) { return point.slope <= 0.0 || point.slope > horizon; });
  points.push_back({0.0, 0.0});
  std::sort(points.begin(), points.end());
  spread_roots(points);
  return points;
}

double arcs_per_slope(Masking masking, double critical) {
  const double zones = masking == Masking::kIntegral || masking == Masking::kVCavity ? 3.0 : 1.0;
  return critical > 0.0 ? 2.0 * zones : zones;
}

// Loops of one invocation: below the 65,535 iterations at which lavapipe stops without notice.
constexpr double kMostIterations = 64'000.0;

// Bound of the loop iterations of one invocation, that is of one piece: slopes, arcs, azimuths, with everything at its
// most nodes. No bound on what an entry does is enough, because invocations that run in lockstep wait for each other.
double iterations(const kernel::RuleNode& rule, double phi_order, double arcs) {
  return rule.largest_order * (1.0 + arcs * (2.0 + phi_order));
}

// The most nodes of an arc; the error estimate shows what that costs.
double phi_order(const kernel::RuleNode& rule, double arcs) {
  const double of_slope = kMostIterations / rule.largest_order - 1.0;
  return std::min(rule.largest_order, std::floor(of_slope / arcs - 2.0));
}

kernel::ThetaNode theta_node(const MomentsRequest& request, const kernel::RuleNode& rule, double theta_deg,
                             const Variant& variant) {
  const CosSin a = cos_sin_deg(theta_deg);
  const RuleModel& model = rule_model(request.masking);
  kernel::ThetaNode node{};
  node.c = a.cos;
  node.s = a.sin;
  const std::vector<Breakpoint> points = breakpoints(theta_deg, a, request.masking, variant);
  assert(points.size() <= DOLP_MAX_PIECES + 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    node.end[i] = points[i].slope;
    node.kind[i] = points[i].kind;
  }
  node.piece_count = static_cast<double>(points.size() - 1);
  node.has_line = variant.has_line ? 1.0 : 0.0;
  // Toward grazing incidence the pseudo-Brewster structure asks for slopes, the horizon for azimuths.
  const double oblique = std::clamp((theta_deg - 65.0) / 15.0, 0.0, 1.0);
  const double grazing = std::clamp((theta_deg - 80.0) / 9.0, 0.0, 1.0) + 0.3 * std::max(0.0, theta_deg - 88.0);
  node.t_growth = 1.0 + model.t_oblique * oblique;
  node.phi_narrowing = 1.0 + model.phi_grazing * grazing;
  if (variant.has_line) {
    node.t_growth *= model.t_line;
    node.phi_narrowing *= model.phi_line;
  }
  if (variant.critical_cos > 0.0) {
    node.t_growth *= kTotalReflectionGrowthT;
    node.phi_narrowing *= kTotalReflectionNarrowing;
  }
  node.phi_order = phi_order(rule, arcs_per_slope(request.masking, variant.critical_cos));
  return node;
}

// Slope beyond which less than `share` of the facets' weight lies, weighted by 1 and by slope.
double slope_cut(const MomentsRequest& request, const SlopeShape& shape, double share) {
  const double m = slope_width(shape);
  if (request.distribution == Distribution::kGaussian) return m * std::sqrt(1.0 - std::log(share));
  const double exponent = shape.q - 1.5;
  if (exponent <= 0.0) return kLargestCut;
  return std::min(kLargestCut, m * power_law_reach(share, exponent));
}

kernel::ShapeNode shape_node(const MomentsRequest& request, const SlopeShape& shape) {
  kernel::ShapeNode node{};
  node.m = slope_width(shape);
  node.q_minus_1 = shape.q - 1.0;
  const bool cauchy = request.distribution == Distribution::kCauchy;
  node.marginal_norm = (cauchy ? gamma_ratio(node.q_minus_1) : 1.0) / (root_pi<double>() * node.m);
  node.two_q_minus_3 = 2.0 * shape.q - 3.0;
  node.scale = std::min(cauchy ? node.m / std::sqrt(std::max(1.0, 0.25 * shape.q)) : node.m, 1.0);
  node.cut = slope_cut(request, shape, kCutShare * request.tolerance);
  const double width = cauchy ? node.m / std::sqrt(std::max(1.0, shape.q / 1.5)) : node.m;
  const bool heavy_tail = cauchy && shape.q < kLightTailQ;
  node.table_scale = std::clamp(width, heavy_tail ? kSmallestHeavyTableScale : 0.0, kLargestTableScale);
  node.cusp_digits =
      cusp_digits(request.distribution, request.masking, shape, rule_digits(request.masking, request.tolerance));
  return node;
}

kernel::IndexNode index_node(const OpticalConstants& index) {
  const std::complex<double> n(index.n, index.k);
  const double n2m1_re = (index.n - 1.0) * (index.n + 1.0) - index.k * index.k;
  const double n2m1_im = 2.0 * index.n * index.k;
  const double pole = 1.0 / std::sqrt(std::max(std::abs(n * n + 1.0), kSmallestPole));
  const double branch_point = std::sqrt(std::max(std::hypot(n2m1_re, n2m1_im), kSmallestPole));
  return {n2m1_re, n2m1_im, std::min(pole, branch_point), critical_cos(index)};
}

// Gives each entry the variant of its direction that it needs.
void add_directions(KernelData& data, const MomentsRequest& request) {
  std::vector<bool> has_line;
  for (const SlopeShape& shape : request.shapes) {
    has_line.push_back(needs_line(request.distribution, request.masking, shape, data.rule.digits));
  }
  std::map<std::pair<std::uint32_t, Variant>, std::uint32_t> nodes;
  for (const double theta_deg : request.theta_deg) {
    nodes[{static_cast<std::uint32_t>(data.thetas.size()), Variant{}}] = static_cast<std::uint32_t>(data.thetas.size());
    data.thetas.push_back(theta_node(request, data.rule, theta_deg, {}));
  }
  for (MomentsEntry& entry : data.entries) {
    const Variant variant{data.indices[entry.index].critical_cos, has_line[entry.shape]};
    if (variant == Variant{}) continue;
    const auto [found, is_new] =
        nodes.try_emplace({entry.theta, variant}, static_cast<std::uint32_t>(data.thetas.size()));
    if (is_new) {
      data.thetas.push_back(theta_node(request, data.rule, request.theta_deg[entry.theta], variant));
    }
    entry.theta = found->second;
  }
}

}  // namespace

std::uint32_t piece_count(const kernel::ThetaNode& theta, const kernel::ShapeNode& shape) {
  const auto all = static_cast<std::uint32_t>(theta.piece_count);
  std::uint32_t count = 1;
  while (count < all && theta.end[count] < shape.cut) ++count;
  return count;
}

void add_piece(kernel::MomentsNode& sum, const kernel::MomentsNode& piece) {
  sum.r_i += piece.r_i;
  sum.r_q += piece.r_q;
  sum.albedo += piece.albedo;
  sum.deficit += piece.deficit;
  sum.doubt += piece.doubt;
  sum.deficit_doubt += piece.deficit_doubt;
  sum.deficit_scale += piece.deficit_scale;
  sum.evaluations += piece.evaluations;
}

KernelData kernel_data(const MomentsRequest& request) {
  const double digits = rule_digits(request.masking, request.tolerance);
  KernelData data;
  data.distribution = request.distribution;
  data.masking = request.masking;
  data.tolerance = request.tolerance;
  data.rule = rule_node(request.masking, digits);
  for (const SlopeShape& shape : request.shapes) data.shapes.push_back(shape_node(request, shape));
  for (const OpticalConstants& index : request.indices) data.indices.push_back(index_node(index));
  data.entries = request.entries;
  add_directions(data, request);
  data.rule_nodes = rule_nodes(static_cast<int>(data.rule.largest_order));
  data.doubts = DoubtModel(data.distribution, data.masking, digits, data.thetas, data.shapes, data.indices);
  return data;
}

double worst_iterations(const KernelData& data) {
  double worst = 0.0;
  for (const MomentsEntry& entry : data.entries) {
    const double arcs = arcs_per_slope(data.masking, data.indices[entry.index].critical_cos);
    worst = std::max(worst, iterations(data.rule, data.thetas[entry.theta].phi_order, arcs));
  }
  return worst;
}

}  // namespace dolp
