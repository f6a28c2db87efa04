#include "plan/kernel_data.hpp"

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/math/special_functions/cos_pi.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <boost/math/special_functions/sin_pi.hpp>
#include <cmath>
#include <limits>

#include "plan/rule_nodes.hpp"

namespace dolp {
namespace {

using boost::math::constants::pi;
using boost::math::constants::root_pi;

constexpr double kEndAbove = 1.0;  // square-root end just above a breakpoint
constexpr double kEndBelow = 2.0;  // just below
constexpr double kNoEnd = 1e30;    // a slope beyond every cut, in place of infinity

// The rule aims this many digits beyond the tolerance, so that the coarser rule it is compared with meets the tolerance.
constexpr double kExtraDigits = 2.0;

// Largest slope that is ever integrated: beyond it the squares of a float overflow.
constexpr double kLargestCut = 1e8;

// Scale of the masking table: its end, 5e8 scales away, must lie far beyond slope 1, where p is a power law.
constexpr double kSmallestTableScale = 1e-4;
constexpr double kLargestTableScale = 0.5;

// Bound of the interpolation error of G (cubic Hermite, 16 cells an octave), relative to the albedo.
constexpr double kMaskingTableError = 1e-6;

// Rounding error in units of the precision's roundoff, relative to the integral of absolute values. The masking table
// of a tail that falls like tau^(2-2q) is a sum of hundreds of equal terms when q is near 1.
constexpr double kRoundings = 40.0;
constexpr double kHeavyTailRoundings = 160.0;
constexpr double kHeavyTailQ = 1.1;

struct Breakpoint {
  double slope;
  double kind;
};

double tan_deg(double angle_deg) {
  const CosSin a = cos_sin_deg(angle_deg);
  return a.sin / a.cos;
}

// Slopes at which the set of smooth arcs changes (MODEL.md section 3; NUMERICS: exact split lines).
std::vector<Breakpoint> breakpoints(double theta_deg, const CosSin& a, Masking masking) {
  std::vector<Breakpoint> points = {{a.cos / (1.0 + a.sin), kEndAbove},
                                    {a.cos > 0.0 ? (1.0 + a.sin) / a.cos : kNoEnd, kEndBelow}};
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
  std::sort(points.begin(), points.end(), [](const auto& x, const auto& y) { return x.slope < y.slope; });
  return points;
}

kernel::ThetaNode theta_node(const MomentsRequest& request, double theta_deg, double digits) {
  const CosSin a = cos_sin_deg(theta_deg);
  kernel::ThetaNode node{};
  node.c = a.cos;
  node.s = a.sin;
  const double horizon = a.cos > 0.0 ? (1.0 + a.sin) / a.cos : kNoEnd;
  int pieces = 0;
  for (const Breakpoint& point : breakpoints(theta_deg, a, request.masking)) {
    if (point.slope <= 0.0 || point.slope > horizon) continue;
    ++pieces;
    node.end[pieces] = point.slope;
    node.kind[pieces] = point.kind;
  }
  node.piece_count = pieces;
  const double grazing = std::clamp((theta_deg - 80.0) / 9.0, 0.0, 1.0);
  node.order_t = digits * (2.4 + 0.9 * grazing) + 2.5;
  node.order_per_e = node.order_t / (digits * std::log(10.0));
  const double smooth = 0.2 + digits * (0.97 + 0.6 * grazing * grazing + 0.3 * std::max(0.0, theta_deg - 88.0));
  const double cusp = request.distribution == Distribution::kCauchy ? 2.0 * digits : 1.6 * digits;
  node.order_phi = std::ceil(request.masking == Masking::kSmith ? std::max(smooth, cusp) : smooth);
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
  node.scale = std::min(cauchy ? node.m / std::sqrt(std::max(1.0, 0.25 * shape.q)) : node.m, 1.0);
  node.cut = slope_cut(request, shape, 1e-3 * request.tolerance);
  const double width = cauchy ? node.m / std::sqrt(std::max(1.0, shape.q / 1.5)) : node.m;
  node.table_scale = std::clamp(width, kSmallestTableScale, kLargestTableScale);
  return node;
}

// Upper bound of the albedo integral (times cos theta) over the slopes T beyond the cut, which the kernel leaves out:
// e <= c + s t, so that it is at most c * tail(T) + 2 s * integral of P t^2 over t > T.
double cut_bound(Distribution distribution, Masking masking, const kernel::ThetaNode& theta,
                 const kernel::ShapeNode& shape) {
  if (shape.cut >= theta.end[static_cast<std::size_t>(theta.piece_count)]) return 0.0;
  const double u = shape.cut / shape.m;
  if (masking == Masking::kVCavity) {  // e G <= 2 c
    const double exponent = distribution == Distribution::kCauchy ? shape.q_minus_1 * std::log1p(u * u) : u * u;
    return 2.0 * theta.c * std::exp(-exponent);
  }
  if (distribution == Distribution::kGaussian) {
    const double tail = std::exp(-u * u);
    return tail * (theta.c + theta.s * shape.m / pi<double>() * (u + 0.5 / u));
  }
  if (shape.q_minus_1 <= 0.5) return std::numeric_limits<double>::infinity();
  const double log_square = std::log1p(u * u);
  const double slope_tail = shape.q_minus_1 * shape.m / pi<double>() * std::exp((0.5 - shape.q_minus_1) * log_square);
  return theta.c * std::exp(-shape.q_minus_1 * log_square) + 2.0 * theta.s * slope_tail / (2.0 * shape.q_minus_1 - 1.0);
}

kernel::IndexNode index_node(const OpticalConstants& index) {
  return {(index.n - 1.0) * (index.n + 1.0) - index.k * index.k, 2.0 * index.n * index.k};
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
  data.rule_nodes = rule_nodes();
  for (const double theta_deg : request.theta_deg) data.thetas.push_back(theta_node(request, theta_deg, digits));
  for (const SlopeShape& shape : request.shapes) data.shapes.push_back(shape_node(request, shape));
  for (const OpticalConstants& index : request.indices) data.indices.push_back(index_node(index));
  return data;
}

Moments moments_from_kernel(const kernel::MomentsNode& node, const MomentsRequest& request, const KernelData& data,
                            const MomentsEntry& entry, double unit_roundoff) {
  const kernel::ShapeNode& shape = data.shapes[entry.shape];
  const double cut = cut_bound(request.distribution, request.masking, data.thetas[entry.theta], shape);
  const double masking = data.needs_masking_table() ? kMaskingTableError : 0.0;
  const bool heavy_tail = request.distribution == Distribution::kCauchy && shape.q_minus_1 < kHeavyTailQ - 1.0;
  const double rounding = unit_roundoff * (masking > 0.0 && heavy_tail ? kHeavyTailRoundings : kRoundings);
  Moments moments;
  moments.r_i = node.r_i;
  moments.r_q = node.r_q;
  moments.albedo = node.albedo;
  moments.deficit = node.deficit;
  moments.r_i_error = 2.0 * node.r_i_difference + (rounding + masking) * node.r_i + cut;
  moments.r_q_error = 2.0 * node.r_q_difference + (rounding + masking) * node.r_i + cut;
  moments.albedo_error = 2.0 * node.albedo_difference + (rounding + masking) * node.albedo + cut;
  moments.deficit_error =
      2.0 * node.deficit_difference + rounding * node.deficit_scale + masking * node.albedo + cut;
  moments.evaluations = node.evaluations;
  return moments;
}

}  // namespace dolp
