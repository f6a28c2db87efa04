#include "plan/kernel_data.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <boost/functional/hash.hpp>
#include <chrono>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <stdexcept>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "base/numbers.hpp"
#include "base/parallel_ranges.hpp"
#include "base/stopwatch.hpp"
#include "model/angles.hpp"
#include "model/films.hpp"
#include "model/response_basis.hpp"
#include "model/slopes.hpp"
#include "model/smooth_surface.hpp"
#include "plan/breakpoints.hpp"
#include "plan/constants.hpp"
#include "plan/reflectance_curve.hpp"
#include "plan/rule.hpp"

namespace dolp {
namespace {

using std::numbers::pi;

constexpr double kSmallestPole = 1e-6;  // least modulus of N^2 + 1 and N^2 - 1; keeps the pole -1/sqrt(N^2 + 1) finite

/// Largest numbers of loop iterations for a piece of the slope axis. iterations() adds the loops over the nodes.
struct Loops {
  double arcs = 1.0;     ///< arcs into which the azimuths are divided at one slope
  double turns = 0.0;    ///< in runs with scattering = multiple: iterations for the bounces of one ray
  double corners = 0.0;  ///< kinks of a sky and of measured reflectances, at which arcs are divided further
};

// Loop iterations for a ray: one for each bounce or group of bounces (next_bounces in groove.glsl).
double ray_turns(double bounces) {
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

// Loop iterations in grooves with slopes up to `end`. At slope cot(gamma) a vertical ray bounces pi / (2 gamma) times.
Loops groove_loops(const KernelData& data, double start, double end) {
  const double most = pi / (2.0 * std::atan(1.0 / end));
  const double splits = data.rule.split_bounces;
  Loops loops;
  loops.arcs = start >= slope_with_bounces(splits + 2.0) ? 2.0 : 5.0;
  if (start < DOLP_STEEPEST_SPLIT) loops.arcs += std::min(splits, std::max(std::floor(most) - 1.0, 0.0));
  // Rays that lean away from the facet bounce up to twice as often as vertical rays.
  loops.turns = ray_turns(std::min(2.0 * most, double{DOLP_LAST_BOUNCES}));
  return loops;
}

Loops slope_loops(const KernelData& data, const DirectionVariant& variant, double start, double end) {
  Loops loops;
  if (data.scattering == Scattering::kMultiple) {
    loops = groove_loops(data, start, end);
  } else {
    if (data.masking == Masking::kIntegral || data.masking == Masking::kVCavity) loops.arcs = 3.0;
    if (data.has_direct) loops.arcs += data.masking == Masking::kVCavity ? 2.0 : 1.0;
  }
  if (variant.critical_cos > 0.0) loops.arcs *= 2.0;
  loops.corners = data.sky.corners + static_cast<double>(variant.kinks_deg.size());
  return loops;
}

constexpr double kMostIterations = 64'000.0;  // the driver lavapipe stops an invocation after 65,535, without an error
constexpr double kMostArcs = 2.0 * DOLP_MAX_ARCS;
constexpr double kTurnsOfSlope = DOLP_MOST_SPLITS + 1.0;  // iterations that split the azimuths at one slope in a groove

// Upper bound of the loop iterations of one invocation, with at most `most_nodes` nodes on an arc.
double iterations(const KernelData& data, const Loops& loops, double most_nodes) {
  const double arcs = loops.arcs + loops.corners;
  // Iterations that integrate nothing: each arc also loops over the kinks that lie outside the arc.
  const double idle = data.sky.count == 0 && loops.corners == 0.0 ? 0.0 : 2.0 * loops.arcs * (1.0 + loops.corners);
  if (!data.needs_masking_table()) return kTurnsOfSlope + idle + arcs * (2.0 + most_nodes * (1.0 + loops.turns));
  const auto rule_iterations = [&](double share) {
    return 1.0 + share * data.rule_order * (1.0 + idle + arcs * (2.0 + share * most_nodes));
  };
  return rule_iterations(1.0) + rule_iterations(kCoarseShare + 1.0 / data.rule_order);
}

std::uint8_t most_nodes(const KernelData& data, const Loops& loops) {
  int most = data.rule_order;
  while (iterations(data, loops, most) > kMostIterations) --most;
  return static_cast<std::uint8_t>(most);
}

std::pair<kernel::ThetaNode, Pieces> direction_node(const KernelData& data, const MomentsRequest& request,
                                                    double theta_deg, const DirectionVariant& variant) {
  const CosSin a = cos_sin_deg(theta_deg);
  kernel::ThetaNode node{};
  node.c = a.cos;
  node.s = a.sin;
  const std::vector<Breakpoint> points =
      breakpoints(theta_deg, request, variant, data.sky, static_cast<int>(data.rule.split_bounces));
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
    const Loops loops = slope_loops(data, variant, node.end[i], node.end[i + 1]);
    pieces.most_nodes[i] = most_nodes(data, loops);
    pieces.lockstep[i] = static_cast<std::uint16_t>(kMostArcs * loops.turns + loops.arcs);
  }
  return {node, pieces};
}

// The slope at which the integral ends. Steeper facets are less than `share` of all facets. They contribute at most
// about 6 times `share` of the mean slope, unless the integral ends at kLargestCut, the limit for Cauchy slopes.
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

kernel::IndexNode index_node(const FacetOptics& optics) {
  const auto [n, k] = optics.index;
  const std::complex<double> n_complex(n, k);
  const std::complex<double> n2m1((n - 1.0) * (n + 1.0) - k * k, 2.0 * n * k);
  const auto bounded_root = [](std::complex<double> square) {
    return std::sqrt(std::abs(square) > kSmallestPole ? square : std::complex<double>(kSmallestPole));
  };
  const std::complex<double> pole = -1.0 / bounded_root(n_complex * n_complex + 1.0);
  const std::complex<double> branch = bounded_root(n2m1);
  return {n2m1.real(),
          n2m1.imag(),
          pole.real(),
          std::abs(pole.imag()),
          std::abs(branch.imag()),
          std::abs(branch.real()),
          critical_cosine(optics),
          0.0,
          0.0};
}

double tables_tolerance(const MomentsRequest& request) {
  return std::max(request.tolerance, kTablesShareOfTolerance * request.scene_tolerance);
}

// Adds the reflectance tables of all indices. Equal indices share a table. Interference fringes of films also increase
// the numbers of nodes.
void add_curves(KernelData& data, const MomentsRequest& request, Tables tables) {
  data.has_curves = std::ranges::any_of(request.optics, [](const FacetOptics& optics) { return !optics.is_bare(); });
  if (!data.has_curves) return;
  const auto start = std::chrono::steady_clock::now();
  std::vector<const FacetOptics*> different;
  std::map<FacetOptics, std::size_t> numbers;
  for (const FacetOptics& optics : request.optics) {
    if (numbers.try_emplace(optics, different.size()).second) different.push_back(&optics);
  }
  double fringes = 0.0;
  for (const FacetOptics* optics : different) fringes = std::max(fringes, fringe_count(*optics));
  std::vector<RowKinks> kinks;
  std::vector<std::uint32_t> kinks_numbers;
  for (const FacetOptics* optics : different) {
    kinks.push_back(row_kinks(*optics, request.tolerance, DOLP_MOST_ROW_KINKS - data.sky.corners));
    const auto known = std::ranges::find(data.kinks_deg, kinks.back().split_deg);
    kinks_numbers.push_back(static_cast<std::uint32_t>(known - data.kinks_deg.begin()));
    if (known == data.kinks_deg.end()) data.kinks_deg.push_back(kinks.back().split_deg);
  }
  for (const FacetOptics& optics : request.optics) data.index_kinks.push_back(kinks_numbers[numbers.at(optics)]);
  const bool is_counted = tables == Tables::kCounted;
  if (is_counted) different = {different[different.size() / 2]};  // a film may need many megabytes for each wavelength
  std::vector<ReflectanceCurve> curves(different.size());
  const double tolerance = tables_tolerance(request);
  parallel_for(curves.size(), 1, [&](std::size_t i) { curves[i] = reflectance_curve(*different[i], tolerance); });
  std::vector<double> starts;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    std::vector<double> split_deg = kinks[numbers.at(*different[i])].split_deg;
    std::ranges::sort(split_deg, std::ranges::greater());
    const std::size_t before = data.rule_nodes.size() + split_deg.size() + 1;
    const std::size_t aligned = (before + DOLP_CURVE_ALIGNMENT - 1) / DOLP_CURVE_ALIGNMENT;
    starts.push_back(static_cast<double>(aligned));
    data.rule_nodes.resize(aligned * DOLP_CURVE_ALIGNMENT - split_deg.size() - 1);
    for (const double angle_deg : split_deg) data.rule_nodes.push_back({cos_sin_deg(angle_deg).cos, 0.0});
    data.rule_nodes.push_back({static_cast<double>(split_deg.size()), 0.0});
    data.rule_nodes.insert(data.rule_nodes.end(), curves[i].nodes.begin(), curves[i].nodes.end());
  }
  constexpr std::size_t kAround = DOLP_CURVE_ALIGNMENT + DOLP_MOST_ROW_KINKS + 1;
  if (is_counted) data.left_out_nodes = (numbers.size() - 1) * (curves.front().nodes.size() + kAround);
  for (std::size_t i = 0; i < request.optics.size(); ++i) {
    const std::size_t number = is_counted ? 0 : numbers.at(request.optics[i]);
    const ReflectanceCurve& curve = curves[number];
    data.indices[i].curve_start = starts[number];
    data.indices[i].curve_cells = (request.optics[i].measured ? -1.0 : 1.0) * static_cast<double>(curve.cells);
    data.indices[i].pole_re = curve.pole.real();
    data.indices[i].pole_im = curve.pole.imag();
    const double unsplit = kinks[numbers.at(request.optics[i])].unsplit;
    data.curve_errors.push_back({curve.error + kUnsplitKinks * unsplit, curve.steepness});
  }
  data.rule.t_nodes += kNodesOfFringe * fringes;
  data.rule.phi_nodes += kNodesOfFringe * fringes;
  data.curves_s = seconds_since(start);
}

// Position in KernelData::kinks_deg.
std::uint32_t kinks_number(const KernelData& data, std::uint32_t index) {
  return data.index_kinks.empty() ? 0 : data.index_kinks[index];
}

// Adds the directions of all bundles. Bundles share a direction if total reflection begins at the same cosine for their
// indices, and their reflectances are split at the same kinks. If some shapes need a split at the kink of their
// masking, they have a direction of their own.
void add_directions(KernelData& data, const MomentsRequest& request) {
  constexpr std::size_t kDirectionsAtOnce = 512;
  using Key = std::array<double, 4>;  // position in theta_deg, DirectionVariant
  std::unordered_map<Key, std::uint32_t, boost::hash<Key>> known;
  std::vector<Key> keys;
  std::array<bool, 2> needs{};  // a shape of the bundle needs a direction without, with the split
  const Bundle* before = nullptr;
  for (const Bundle& bundle : data.bundles) {
    if (before == nullptr || bundle.first != before->first || bundle.count != before->count) {
      needs = {};
      for (const std::uint32_t shape : request.bundle_shapes(bundle)) needs[data.needs_line[shape] != 0 ? 1 : 0] = true;
    }
    before = &bundle;
    std::array<std::uint32_t, 2>& thetas = data.bundle_thetas.emplace_back();
    for (std::size_t line = 0; line < needs.size(); ++line) {
      if (!needs[line]) continue;
      const Key key{static_cast<double>(bundle.direction), data.indices[bundle.index].critical_cos,
                    static_cast<double>(line), static_cast<double>(kinks_number(data, bundle.index))};
      const auto [found, is_new] = known.try_emplace(key, static_cast<std::uint32_t>(keys.size()));
      if (is_new) keys.push_back(key);
      thetas[line] = found->second;
    }
  }
  data.thetas.resize(keys.size());
  data.pieces.resize(keys.size());
  parallel_for(keys.size(), kDirectionsAtOnce, [&](std::size_t i) {
    const auto& [direction, critical_cos, line, kinks] = keys[i];
    const double theta_deg = request.theta_deg[static_cast<std::size_t>(direction)];
    std::tie(data.thetas[i], data.pieces[i]) = direction_node(
        data, request, theta_deg, {critical_cos, line != 0.0, data.kinks_deg[static_cast<std::size_t>(kinks)]});
  });
}

void add_shape(KernelData& data, const MomentsRequest& request, const SlopeShape& shape) {
  const double digits = data.rule.digits;
  data.slopes.push_back(shape);
  data.shapes.push_back(shape_node(request, {.sigma = widest_sigma(shape), .q = shape.q}, digits));
  if (is_elliptic(shape)) {
    data.shapes.back().scale = shape_node(request, {.sigma = narrowest_sigma(shape), .q = shape.q}, digits).scale;
  }
  const bool is_split = needs_line(request.distribution, request.masking, shape, digits, request.tolerance);
  data.needs_line.push_back(is_split ? 1 : 0);
}

static_assert(kMostResponses == DOLP_COLUMNS);

/// The reflectance of an index has a pole at some complex cos(beta). The kernel chooses its numbers of nodes from this
/// pole. The polynomials of the responses need as many nodes as a reflectance with a pole at i * bend. So i * bend
/// replaces each pole that is farther from 0.
void take_responses(KernelData& data, const Response& response) {
  data.response = response;
  data.rule.response_scale = 1.0 / response.c0;
  data.rule.response_norm = 2.0 / std::asinh(1.0 / response.c0);
  for (kernel::IndexNode& index : data.indices) {
    if (std::hypot(index.pole_re, index.pole_im) <= response.bend) continue;
    index.pole_re = 0.0;
    index.pole_im = response.bend;
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

KernelData kernel_data(const MomentsRequest& request, Tables tables) {
  if (request.has_only_direct()) {  // smith masking is one factor of the emission that leaves the facets
    MomentsRequest facets = request;
    facets.masking = Masking::kNone;
    KernelData data = kernel_data(facets, tables);
    data.has_only_direct = true;
    return data;
  }
  return kernel_data(request, rule_model(request.masking, request.scattering), tables);
}

KernelData kernel_data(const MomentsRequest& request, const RuleModel& model, Tables tables) {
  const double digits = rule_digits(model, request.tolerance);
  KernelData data;
  data.distribution = request.distribution;
  data.masking = request.masking;
  data.scattering = request.scattering;
  data.has_direct = request.wants_direct;
  data.tolerance = request.tolerance;
  data.rule = rule_node(model, request.tolerance);
  data.orders = slope_orders(request);
  data.rule_order = std::min(largest_order(digits) + nodes_of_orders(data.orders), DOLP_MAX_ORDER);
  data.bundles = request.bundles;
  data.members = request.members;
  data.rule_nodes = rule_nodes(data.rule_order);
  const bool is_single = request.scattering == Scattering::kSingle;
  const SkyTolerances for_sky{request.tolerance, tables_tolerance(request)};
  if (request.sky) data.sky = append_sky(*request.sky, for_sky, is_single, data.rule_nodes);
  for (const FacetOptics& index : request.optics) data.indices.push_back(index_node(index));
  add_curves(data, request, tables);
  if (request.response) take_responses(data, *request.response);
  for (const SlopeShape& shape : request.shapes) add_shape(data, request, shape);
  add_directions(data, request);
  data.has_total_reflection =
      std::ranges::any_of(data.indices, [](const kernel::IndexNode& index) { return index.critical_cos > 0.0; });
  return data;
}

}  // namespace dolp
