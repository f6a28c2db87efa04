#include "plan/kernel_data.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "base/numbers.hpp"
#include "model/angles.hpp"
#include "model/gamma_ratio.hpp"
#include "plan/constants.hpp"
#include "plan/rule.hpp"
#include "plan/rule_nodes.hpp"

namespace dolp {
namespace {

using std::numbers::pi;

constexpr unsigned kRoots = kRootAbove | kRootBelow;
constexpr double kNoEnd = 1e30;  // a slope beyond every cut, in place of infinity

constexpr double kCoincident = 1e-9;  // relative distance of breakpoints that differ only by rounding

constexpr double kSmallestPole = 1e-6;  // of |N^2 + 1| and |N^2 - 1|

// Largest slope that is ever integrated: beyond it the squares of a float overflow.
constexpr double kLargestCut = 1e15;

// Of breakpoints before the corners of a sky, and with them.
constexpr std::size_t kMostSkyBreakpoints = 60;

// Slopes that only split the long way to the horizon of a grazing direction, where a heavy tail reaches far, into
// pieces of ten units of X or so.
constexpr std::array kPlainBreakpoints = {30.0, 3e5};
constexpr std::array kSteepBreakpoints = {1e5, 3e8, 1e12};  // the same of grooves, which have no horizon

struct Breakpoint {
  double slope;
  unsigned roots;  // bits
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

// Slopes at which the critical line cos(beta) = critical_cos meets phi = 0 or pi, the horizon, theta_r = theta or the
// lines of v-cavity, e = 2 c and e = 2 cos(theta_r).
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
  const double at_slope_1 = std::sqrt(0.5);  // where the lines of v-cavity end
  add(0.5 * critical / a.cos, at_slope_1);
  add(critical / (std::hypot(a.cos, 2.0 * critical) - a.cos), at_slope_1);
}

// Slopes at which the line b = pi/2 of `integral` meets phi = 0 or pi, and theta_r = theta; or smith's cusp.
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

// The direct emission goes on beyond the horizon, up to the line on which facets turn away; with v-cavity masking it
// has the line e = 2 c, which crosses the horizon at sqrt(3).
void add_direct_breakpoints(std::vector<Breakpoint>& points, const CosSin& a, Masking masking, double& last) {
  last = kNoEnd;
  points.push_back({last, 0});
  if (a.sin > 0.0) points.push_back({a.cos / a.sin, kRootAbove});
  if (masking == Masking::kVCavity) points.push_back({std::sqrt(3.0), 0});
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

// Slopes at which a bounce after the first meets the critical line at phi = 0 or pi, where its cos(beta) is the sine of
// its angle in the fan (groove.glsl): where theta is 0 that is everywhere.
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

// Where the lines of groove_lines (arcs.glsl) meet phi = 0, psi = theta, or phi = pi, psi = -theta, or each other.
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

// Variant of a direction: determines its pieces together with the masking.
struct Variant {
  double critical_cos = 0.0;
  bool has_line = false;
};

// Merges breakpoints that differ only by rounding; the merged one has the roots of all.
std::vector<Breakpoint> without_coincident(const std::vector<Breakpoint>& points) {
  std::vector<Breakpoint> distinct;
  for (const Breakpoint& point : points) {
    const bool is_new = distinct.empty() || point.slope > distinct.back().slope * (1.0 + kCoincident);
    if (is_new) distinct.push_back(point);
    distinct.back().roots |= point.roots;
  }
  return distinct;
}

// Splits each piece once more, so that no node of its rules stays where it was.
// Slopes at which a corner of the sky meets phi = 0 or pi: the reflected rays of a slope have zeniths from |theta - 2
// alpha| to theta + 2 alpha. A sky that is not level at the zenith has a cusp there. Beside them the sum over the
// azimuths goes as the distance to the power 3/2.
void add_sky_breakpoints(std::vector<Breakpoint>& points, double theta_deg, const SkyTable& sky) {
  if (sky.has_cusp) points.push_back({tan_deg(0.5 * theta_deg), kRoots});
  for (const double corner_deg : sky.corners_deg) {
    if (points.size() + 2 > kMostSkyBreakpoints) return;
    points.push_back({tan_deg(0.5 * std::abs(corner_deg - theta_deg)), kRootAbove});
    points.push_back({tan_deg(0.5 * (corner_deg + theta_deg)), kRootBelow});
  }
}

void add_extra_splits(std::vector<Breakpoint>& points) {
  constexpr double kShare = 0.43;  // no fraction that a rule's nodes have
  const std::size_t count = points.size();
  for (std::size_t i = 0; i + 1 < count && points.size() <= DOLP_MAX_PIECES; ++i) {
    const double start = std::asinh(points[i].slope);
    const double end = std::asinh(std::min(points[i + 1].slope, kLargestCut));
    if (end > start) points.push_back({std::sinh(start + kShare * (end - start)), 0});
  }
  std::sort(points.begin(), points.end());
}

// Slopes from 0 on at which the set of smooth arcs changes: where a split line of the azimuth (arcs.glsl) meets
// phi = 0 or pi or another line. The horizon does at t1 = c / (1 + s) and t2 = (1 + s) / c, theta_r = theta at
// tan(theta), the limit b = pi/2 at tan(30 -+ 2/3 theta) and, on theta_r = theta, at tan(2 theta - 90); the lines of
// v-cavity at tan(30 -+ theta/3), cot(theta), 1 and tan(theta); smith's cusp is at tan(theta/2).
std::vector<Breakpoint> breakpoints(double theta_deg, const CosSin& a, const MomentsRequest& request,
                                    const Variant& variant, const SkyTable& sky, int splits) {
  const Masking masking = request.masking;
  const bool is_multiple = request.scattering == Scattering::kMultiple;
  const double horizon = a.cos > 0.0 ? (1.0 + a.sin) / a.cos : kNoEnd;
  std::vector<Breakpoint> points;
  double last = horizon;
  if (is_multiple) {
    add_groove_breakpoints(points, theta_deg, splits);
    last = kNoEnd;
    points.push_back({last, 0});
  } else {
    points = {{a.cos / (1.0 + a.sin), kRootAbove}, {horizon, kRootBelow}};
    if (request.wants_direct) add_direct_breakpoints(points, a, masking, last);
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
  add_sky_breakpoints(points, theta_deg, sky);
  std::erase_if(points, [&](const Breakpoint& point) { return point.slope <= 0.0 || point.slope > last; });
  // At the normal smith's cusp lies at slope 0.
  const bool cusp_at_0 = variant.has_line && masking == Masking::kSmith && a.sin == 0.0;
  points.push_back({0.0, cusp_at_0 ? kRootAbove : 0U});
  std::sort(points.begin(), points.end());
  return without_coincident(points);
}

/// Loop bounds of one piece, besides the orders of its rules.
struct Loops {
  double arcs = 1.0;     ///< of a slope
  double turns = 0.0;    ///< all bounces: of an azimuth
  double corners = 0.0;  ///< of a sky, that split the arcs
};

Loops single_loops(const KernelData& data) {
  double arcs = data.masking == Masking::kIntegral || data.masking == Masking::kVCavity ? 3.0 : 1.0;
  if (data.has_direct) arcs += data.masking == Masking::kVCavity ? 2.0 : 1.0;
  return {.arcs = arcs};
}

// Loop iterations of a ray with `bounces` bounces: one for each bounce, or for each group of bounces that next_bounces
// of groove.glsl takes as one.
double turns_of(double bounces) {
  double turns = 2.0;
  double taken = 1.0;
  for (double done = 0.0; done < bounces; done += taken) {
    const double distance = std::min(done, bounces - done) / DOLP_GROUPS_PER_DISTANCE;
    if (bounces > DOLP_MOST_BOUNCES && 2.0 * taken <= distance) {
      taken *= 2.0;
    } else if (taken > std::max(distance, 1.0)) {
      taken *= 0.5;
    }
    turns += taken > 1.0 ? 2.0 : 1.0;
  }
  return turns;
}

// Loop bounds of a piece from slope `start` to `end`, with pi / (2 gamma) bounces and more. Steep grooves have no lines
// below gamma.
Loops groove_loops(const KernelData& data, double start, double end) {
  const double most = pi / (2.0 * std::atan(1.0 / end));
  const double splits = data.rule.split_bounces;
  Loops loops;
  loops.arcs = start >= slope_with_bounces(splits + 2.0) ? 2.0 : 5.0;
  if (start < DOLP_STEEPEST_SPLIT) loops.arcs += std::min(splits, std::max(std::floor(most) - 1.0, 0.0));
  // Rays that lean away from the facet have twice as many.
  loops.turns = turns_of(std::min(2.0 * most, double{DOLP_LAST_BOUNCES}));
  return loops;
}

Loops loops_of(const KernelData& data, double critical, double start, double end) {
  Loops loops = data.scattering == Scattering::kMultiple ? groove_loops(data, start, end) : single_loops(data);
  if (critical > 0.0) loops.arcs *= 2.0;
  loops.corners = data.sky.corners;
  return loops;
}

// Loops of one invocation: below the 65,535 iterations at which lavapipe stops without notice.
constexpr double kMostIterations = 64'000.0;
constexpr double kMostArcs = 2.0 * DOLP_MAX_ARCS;
constexpr double kTurnsOfSlope = DOLP_MOST_SPLITS + 1.0;  // of a groove, to find its lines

// Bound of the loop iterations of one invocation with everything at its most nodes: of one piece, two rules, slopes,
// arcs and azimuths, or of one slope sample, arcs, azimuths and bounces. A bound for each entry
// alone would not suffice, because invocations that run in lockstep wait for each other.
double iterations(const KernelData& data, const Loops& loops, double most_nodes) {
  const double arcs = loops.arcs + loops.corners;
  const double idle = data.sky.count == 0 ? 0.0 : 2.0 * loops.arcs * (1.0 + loops.corners);  // corners beyond an arc
  if (!data.needs_masking_table()) return kTurnsOfSlope + idle + arcs * (2.0 + most_nodes * (1.0 + loops.turns));
  const auto of_rule = [&](double share) {
    return 1.0 + share * data.rule_order * (1.0 + idle + arcs * (2.0 + share * most_nodes));
  };
  return of_rule(1.0) + of_rule(kCoarseShare + 1.0 / data.rule_order);
}

// Upper limit of the nodes of an arc; the error estimate includes the effect of the limit.
std::uint8_t most_nodes(const KernelData& data, const Loops& loops) {
  int most = data.rule_order;
  while (iterations(data, loops, most) > kMostIterations) --most;
  return static_cast<std::uint8_t>(most);
}

void add_direction(KernelData& data, const MomentsRequest& request, double theta_deg, const Variant& variant) {
  const CosSin a = cos_sin_deg(theta_deg);
  kernel::ThetaNode node{};
  node.c = a.cos;
  node.s = a.sin;
  std::vector<Breakpoint> points =
      breakpoints(theta_deg, a, request, variant, data.sky, static_cast<int>(data.rule.split_bounces));
  if (request.has_extra_splits) add_extra_splits(points);
  if (points.size() > DOLP_MAX_PIECES + 1) throw std::logic_error("a direction has more pieces than a kernel takes");
  std::ranges::fill(node.end, points.back().slope);
  Pieces pieces;
  for (std::size_t i = 0; i < points.size(); ++i) {
    node.end[i] = points[i].slope;
    pieces.roots[i] = static_cast<std::uint8_t>(points[i].roots);
  }
  pieces.count = static_cast<std::uint32_t>(points.size() - 1);
  pieces.has_split_line = variant.has_line;
  for (std::size_t i = 0; i < pieces.count; ++i) {
    const Loops loops = loops_of(data, variant.critical_cos, node.end[i], node.end[i + 1]);
    pieces.most_nodes[i] = most_nodes(data, loops);
    pieces.lockstep[i] = static_cast<std::uint16_t>(kMostArcs * loops.turns + loops.arcs);
  }
  data.thetas.push_back(node);
  data.pieces.push_back(pieces);
}

// Slope beyond which less than `share` of the facets' weight lies, weighted by 1 and by slope.
double slope_cut(const MomentsRequest& request, const SlopeShape& shape, double share) {
  const double m = slope_width(shape);
  if (request.distribution == Distribution::kGaussian) return m * std::sqrt(1.0 - std::log(share));
  const double exponent = shape.q - 1.5;
  if (exponent <= 0.0) return kLargestCut;
  return std::min(kLargestCut, m * power_law_reach(share, exponent));
}

kernel::ShapeNode shape_node(const MomentsRequest& request, const SlopeShape& shape, double digits) {
  kernel::ShapeNode node{};
  node.m = slope_width(shape);
  node.q_minus_1 = shape.q - 1.0;
  const bool cauchy = request.distribution == Distribution::kCauchy;
  node.marginal_norm = (cauchy ? gamma_ratio(node.q_minus_1) : 1.0) / (kRootPi * node.m);
  node.two_q_minus_3 = 2.0 * shape.q - 3.0;
  node.scale = std::min(cauchy ? node.m / std::sqrt(std::max(1.0, 0.25 * shape.q)) : node.m, 1.0);
  node.cut = slope_cut(request, shape, kCutShare * request.tolerance);
  const double width = cauchy ? node.m / std::sqrt(std::max(1.0, shape.q / 1.5)) : node.m;
  const bool heavy_tail = cauchy && shape.q < kLightTailQ;
  node.table_scale = std::clamp(width, heavy_tail ? kSmallestHeavyTableScale : 0.0, kLargestTableScale);
  node.cusp_digits = cusp_digits(request.distribution, request.masking, shape, digits);
  return node;
}

kernel::IndexNode index_node(const OpticalConstants& index) {
  const std::complex<double> n(index.n, index.k);
  const double n2m1_re = (index.n - 1.0) * (index.n + 1.0) - index.k * index.k;
  const double n2m1_im = 2.0 * index.n * index.k;
  const auto bounded_root = [](std::complex<double> square) {
    return std::sqrt(std::abs(square) > kSmallestPole ? square : std::complex<double>(kSmallestPole));
  };
  const std::complex<double> pole = -1.0 / bounded_root(n * n + 1.0);
  const std::complex<double> branch = bounded_root({n2m1_re, n2m1_im});
  return {n2m1_re,
          n2m1_im,
          pole.real(),
          std::abs(pole.imag()),
          std::abs(branch.imag()),
          std::abs(branch.real()),
          critical_cos(index)};
}

// Every direction of a grid, for each of the lines of total reflection that its indices have, without and with the line
// that some shapes need.
void add_grid_directions(KernelData& data, const MomentsRequest& request) {
  const bool any_line = std::ranges::find(data.needs_line, 1) != data.needs_line.end();
  const std::uint32_t lines = any_line ? 2 : 1;
  std::vector<double> critical = {0.0};
  for (const kernel::IndexNode& index : data.indices) {
    const auto known = std::ranges::find(critical, index.critical_cos);
    data.index_variant.push_back(lines * static_cast<std::uint32_t>(known - critical.begin()));
    if (known == critical.end()) critical.push_back(index.critical_cos);
  }
  for (const double critical_cos : critical) {
    for (std::uint32_t line = 0; line < lines; ++line) {
      for (const double theta_deg : request.theta_deg)
        add_direction(data, request, theta_deg, {critical_cos, line == 1});
    }
  }
}

void add_shape(KernelData& data, const MomentsRequest& request, const SlopeShape& shape) {
  const double digits = data.rule.digits;
  data.shapes.push_back(shape_node(request, shape, digits));
  const bool is_split = needs_line(request.distribution, request.masking, shape, digits, request.tolerance);
  data.needs_line.push_back(is_split ? 1 : 0);
}

void add_grid(KernelData& data, const MomentsRequest& request) {
  for (const double sigma : request.sigma) {
    for (const double q : request.q) add_shape(data, request, {sigma, q});
  }
  add_grid_directions(data, request);
}

void add_points(KernelData& data, const MomentsRequest& request) {
  for (std::size_t i = 0; i < request.size(); ++i) {
    const bool is_new = i == 0 || request[i].shape != request[i - 1].shape;
    if (is_new) add_shape(data, request, request[i].shape);
    data.shape_of.push_back(static_cast<std::uint32_t>(data.shapes.size() - 1));
    add_direction(data, request, request.theta_deg[i], {data.indices[i].critical_cos, data.needs_line.back() != 0});
  }
}

}  // namespace

double slope_with_bounces(double bounces) { return 1.0 / std::tan(0.5 * pi / bounces); }

std::uint32_t task_word(const Pieces& pieces, std::uint32_t piece, std::uint32_t members) {
  const auto bit = [](bool is_set, unsigned position) { return static_cast<std::uint32_t>(is_set) << position; };
  return members | piece << DOLP_TASK_PIECE_SHIFT |
         bit((pieces.roots[piece] & kRootAbove) != 0, DOLP_TASK_ROOT_AT_START) |
         bit((pieces.roots[piece + 1] & kRootBelow) != 0, DOLP_TASK_ROOT_AT_END) |
         bit(piece > 0 && (pieces.roots[piece - 1] & kRootAbove) != 0, DOLP_TASK_ROOT_BEFORE_START) |
         bit(piece + 2 <= pieces.count && (pieces.roots[piece + 2] & kRootBelow) != 0, DOLP_TASK_ROOT_AFTER_END) |
         bit(pieces.has_split_line, DOLP_TASK_SPLIT_LINE) |
         static_cast<std::uint32_t>(pieces.most_nodes[piece]) << DOLP_TASK_AZIMUTHS_SHIFT;
}

std::uint32_t piece_count(const KernelData& data, std::uint32_t theta, const kernel::ShapeNode& shape) {
  std::uint32_t count = 1;
  while (count < data.pieces[theta].count && data.thetas[theta].end[count] < shape.cut) ++count;
  return count;
}

void add_piece(kernel::MomentsNode& sum, const kernel::MomentsNode& piece) {
  using Numbers = std::array<double, sizeof(kernel::MomentsNode) / sizeof(double)>;
  auto numbers = std::bit_cast<Numbers>(sum);
  const auto more = std::bit_cast<Numbers>(piece);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] += more[i];
  sum = std::bit_cast<kernel::MomentsNode>(numbers);
}

KernelData kernel_data(const MomentsRequest& request) {
  return kernel_data(request, rule_model(request.masking, request.scattering));
}

KernelData kernel_data(const MomentsRequest& request, const RuleModel& model) {
  const double digits = rule_digits(model, request.tolerance);
  KernelData data;
  data.distribution = request.distribution;
  data.masking = request.masking;
  data.scattering = request.scattering;
  data.has_direct = request.wants_direct;
  data.tolerance = request.tolerance;
  data.rule = rule_node(model, request.tolerance);
  data.rule_order = largest_order(digits);
  data.is_grid = request.layout == MomentsRequest::Layout::kGrid;
  data.directions = request.theta_deg.size();
  data.rule_nodes = rule_nodes(data.rule_order);
  const bool is_single = request.scattering == Scattering::kSingle;
  if (request.sky) data.sky = append_sky(*request.sky, request.tolerance, is_single, data.rule_nodes);
  for (const OpticalConstants& index : request.indices) data.indices.push_back(index_node(index));
  if (data.is_grid) {
    add_grid(data, request);
  } else {
    add_points(data, request);
  }
  data.has_total_reflection =
      std::ranges::any_of(data.indices, [](const kernel::IndexNode& index) { return index.critical_cos > 0.0; });
  return data;
}

double worst_iterations(const KernelData& data) {
  double worst = 0.0;
  for (std::size_t i = 0; i < data.size(); ++i) {
    const MomentsEntry entry = data[i];
    const double critical = data.indices[entry.index].critical_cos;
    const Pieces& pieces = data.pieces[entry.theta];
    const kernel::ThetaNode& theta = data.thetas[entry.theta];
    for (std::uint32_t piece = 0; piece < pieces.count; ++piece) {
      const Loops loops = loops_of(data, critical, theta.end[piece], theta.end[piece + 1]);
      worst = std::max(worst, iterations(data, loops, pieces.most_nodes[piece]));
    }
  }
  return worst;
}

MomentsEntry KernelData::operator[](std::size_t entry) const {
  if (!is_grid) {
    const auto point = static_cast<std::uint32_t>(entry);
    return {point, shape_of[entry], point};
  }
  const auto shape = static_cast<std::uint32_t>(entry % shapes.size());
  const std::size_t of_index = entry / shapes.size();
  const auto index = static_cast<std::uint32_t>(of_index % indices.size());
  return {theta_of(static_cast<std::uint32_t>(of_index / indices.size()), index, shape), shape, index};
}

}  // namespace dolp
