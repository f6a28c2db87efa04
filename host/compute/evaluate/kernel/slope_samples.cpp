#include "evaluate/kernel/slope_samples.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#define DOLP_KERNEL_NAMESPACE sampling_kernel
#define DOLP_DOUBLE
#include "evaluate/kernel/kernel_source.hpp"
#include "evaluate/kernel/order_sums.hpp"

namespace dolp {

using sampling_kernel::KernelSource;

namespace {

// Between the smallest and the largest width of the slope distributions, piece_ends() divides the slope axis into
// pieces. They are at most this long in ln(slope). Tuned: half the value needs up to 14 % more evaluations.
constexpr double kWidthStep = 1.3;
constexpr double kNodeWidthStep = 0.4;  // largest step of ln(m) between the widths m in corner_shapes()

constexpr double kNoFacets = 80.0;  // pieces with only the steepest exp(-kNoFacets) of the facets are skipped

struct SampleRequest {
  double all = 0.0;  // estimate of the light that all facets reflect upward, from weight_of_shape()
  double digits = 0.0;
};

// An end of a piece of the slope axis: a breakpoint of the direction, or a slope between two breakpoints (kWidthStep).
struct End {
  double slope = 0.0;
  std::uint32_t direction_piece = 0;  // position in ThetaNode::end of the last breakpoint that is not above `slope`
  bool is_breakpoint = false;         // true if `slope` is itself a breakpoint
};

// In the moments of a shape, slope i has the weight common[i] * exp(-exponent_factor(shape) * exponent[i]), except for
// a constant factor. The arrays depend only on the width m of the shape.
struct SlopeWeights {
  double m = 0.0;
  Eigen::ArrayXd exponent;  // common_exponent(slope / m), see slope.glsl
  Eigen::ArrayXd common;
};

// Artificial shapes that replace `shapes`, which may be very many, when slopes are chosen for them all. Their widths m
// go from the smallest to the largest m of `shapes`. Each m occurs with the smallest q and with the largest q.
std::vector<kernel::ShapeNode> corner_shapes(const KernelData& data, std::span<const std::uint32_t> shapes) {
  kernel::ShapeNode corner = data.shapes[shapes.front()];
  double widest = corner.m, lightest = corner.q_minus_1;
  for (const std::uint32_t i : shapes) {
    const kernel::ShapeNode& shape = data.shapes[i];
    corner.scale = std::min(corner.scale, shape.scale);
    corner.cut = std::max(corner.cut, shape.cut);
    corner.m = std::min(corner.m, std::numbers::sqrt2 * narrowest_sigma(data.slopes[i]));
    corner.q_minus_1 = std::min(corner.q_minus_1, shape.q_minus_1);
    widest = std::max(widest, shape.m);
    lightest = std::max(lightest, shape.q_minus_1);
  }
  const double narrowest = corner.m, heaviest = corner.q_minus_1;
  const double steps = std::ceil(std::log(widest / narrowest) / kNodeWidthStep);
  std::vector<kernel::ShapeNode> corners;
  for (double i = 0.0; i <= steps; ++i) {
    corner.m = i == 0.0 ? narrowest : narrowest * std::pow(widest / narrowest, i / steps);
    corner.q_minus_1 = heaviest;
    corners.push_back(corner);
    corner.q_minus_1 = lightest;
    if (lightest > heaviest) corners.push_back(corner);
  }
  return corners;
}

// Additional slope nodes on a piece at whose ends facets begin to turn away from a split line. With the slope, the
// azimuth of the line turns quickly there, and with it cos(2 k phi).
// Tuned at a width ratio of 3, 1e-3 to 1e-5, 120 entries: evaluations with all refinements. With no node, they are 45
// (no masking) and 3 times as many. With all bounces, nodes at the end of a piece do not pay.
int nodes_at_roots(const KernelData& data, const KernelSource::Task& task) {
  const double nodes_of_order = data.masking == Masking::kNone ? 0.75 : 0.25;
  const bool has_root = task.root_at_start || (task.root_at_end && data.scattering == Scattering::kSingle);
  return has_root ? static_cast<int>(std::ceil(nodes_of_order * static_cast<double>(data.orders.highest))) : 0;
}

}  // namespace

bool has_slope_samples(const MomentsRequest& request) {
  if (request.has_elliptic_shapes()) return true;
  const bool can_share = request.masking == Masking::kNone || request.masking == Masking::kVCavity;
  // With lone entries the host's part would take most of the time.
  return can_share && (!request.has_lone_entries || request.scattering == Scattering::kMultiple);
}

struct SlopeSampling::Impl {
  const KernelData& data;
  KernelSource source;
  KernelSource::RuleNode rule;

  explicit Impl(const KernelData& of)
      : data(of), source(KernelSource::of(of)), rule(std::bit_cast<KernelSource::RuleNode>(of.rule)) {}

  // The pieces of the slope axis end at the breakpoints of the direction and at further slopes (see kWidthStep).
  std::vector<End> piece_ends(std::uint32_t theta, std::span<const kernel::ShapeNode> corners) {
    const kernel::ThetaNode& node = data.thetas[theta];
    const double cut = corners.front().cut;
    std::vector<End> ends;
    for (std::uint32_t i = 0; i <= data.pieces[theta].count && (i == 0 || node.end[i - 1] < cut); ++i) {
      ends.push_back({node.end[i], i, true});
    }
    const double last = std::min(ends.back().slope, cut);
    const double narrowest = corners.front().scale;
    const double widest = corners.back().m;
    const auto steps = static_cast<int>(std::log(widest / narrowest) / kWidthStep);
    for (int i = 0; i < steps + (steps > 0 ? 1 : 0); ++i) {
      const double slope = narrowest * std::pow(widest / narrowest, (i + 0.5) / (steps + 1.0));
      if (slope >= last) break;
      const auto after = std::ranges::find_if(ends, [&](const End& end) { return end.slope > slope; });
      ends.insert(after, {slope, (after - 1)->direction_piece, false});
    }
    return ends;
  }

  KernelSource::Task piece_task(std::uint32_t theta, std::span<const End> ends, std::size_t piece) {
    const auto has_root = [&](const End& end, unsigned bit) {
      return end.is_breakpoint && (data.pieces[theta].roots[end.direction_piece] & bit) != 0;
    };
    KernelSource::Task task{};
    const std::size_t last = ends.size() - 1;
    task.members = 1;
    task.piece = static_cast<int>(piece);
    task.root_at_start = has_root(ends[piece], kRootAbove);
    task.root_at_end = has_root(ends[piece + 1], kRootBelow);
    task.root_before_start = piece > 0 && has_root(ends[piece - 1], kRootAbove);
    task.root_after_end = piece + 2 <= last && has_root(ends[piece + 2], kRootBelow);
    task.before = ends[piece > 0 ? piece - 1 : 0].slope;
    task.start = ends[piece].slope;
    task.end = ends[piece + 1].slope;
    task.after = ends[std::min(piece + 2, last)].slope;
    task.last = ends[last].slope;
    return task;
  }

  KernelSource::Piece hardest_piece(const KernelSource::ThetaNode& theta, const KernelSource::IndexNode& index,
                                    std::span<const kernel::ShapeNode> corners, const KernelSource::Task& task,
                                    std::vector<SampleRequest>& requests) {
    KernelSource::Piece hardest{};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      KernelSource::Row row{};
      row.shape[0] = std::bit_cast<KernelSource::ShapeNode>(corners[i]);
      const KernelSource::Piece candidate = source.make_piece(rule, theta, row, index, task);
      requests[i].digits = candidate.digits;
      if (candidate.order > hardest.order) hardest = candidate;
    }
    return hardest;
  }

  void add_rule(SlopeSamples& samples, const KernelSource::ThetaNode& theta, std::span<const kernel::ShapeNode> corners,
                const KernelSource::Piece& piece, const std::vector<SampleRequest>& requests, int order) {
    const int first = source.rule_offset(KernelSource::kSectionGauss, order);
    for (int i = 0; i < order; ++i) {
      const auto node = source.rule_node(first + i);
      const auto on_piece = source.position_on_piece(piece, node.x);
      const auto hyperbolic = source.sinh_cosh(piece.start + piece.extent * on_piece.x);
      const double scale = corners.front().scale;
      SampledSlope slope;
      slope.t = scale * hyperbolic.x;
      slope.dt = 2.0 * node.y * scale * hyperbolic.y * piece.extent * on_piece.y;
      for (std::size_t j = 0; j < corners.size(); ++j) {
        if (requests[j].digits <= slope.digits) continue;  // this shape cannot raise slope.digits
        const auto shape = std::bit_cast<KernelSource::ShapeNode>(corners[j]);
        const double u = slope.t / shape.m;
        const double mass =
            KernelSource::kPi * source.slope_density(shape, u, source.common_exponent(u)) * slope.dt / shape.m;
        slope.digits = std::max(slope.digits, source.digits_of_slope(rule, theta, requests[j].all, requests[j].digits,
                                                                     order, slope.t, mass));
      }
      samples.slopes.push_back(slope);
    }
  }

  SlopeWeights slope_weights(const SlopeSamples& samples, KernelSource::ShapeNode shape) {
    shape.q_minus_1 = 1.0;  // any value: it only multiplies all weights by a constant, which the scaling removes
    const auto count = static_cast<Eigen::Index>(samples.slopes.size());
    SlopeWeights weights{shape.m, Eigen::ArrayXd(count), Eigen::ArrayXd(count)};
    for (Eigen::Index i = 0; i < count; ++i) {
      const SampledSlope& slope = samples.slopes[static_cast<std::size_t>(i)];
      const double u = slope.t / shape.m;
      weights.exponent[i] = source.common_exponent(u);
      weights.common[i] = source.slope_density(shape, u, 0.0) * slope.dt;
    }
    return weights;
  }

  // Integral over a piece of the slope axis by a Gauss rule. The weights are scaled so that their sum is `share`, the
  // exact share of the facets on the piece. This cancels the error of the rule in the slope density.
  static kernel::AzimuthNode sum_azimuths(std::uint32_t first, std::uint32_t count, const Eigen::ArrayXd& shape_weights,
                                          double share, std::span<const kernel::AzimuthNode> azimuths) {
    using Azimuths = Eigen::Matrix<double, sizeof(kernel::AzimuthNode) / sizeof(double), Eigen::Dynamic>;
    const Eigen::Map<const Azimuths> all(&azimuths[first].r_i, Azimuths::RowsAtCompileTime, count);
    const double mass = shape_weights.segment(first, count).sum();
    std::array<double, Azimuths::RowsAtCompileTime> sums{};
    Eigen::Map<Eigen::Matrix<double, Azimuths::RowsAtCompileTime, 1>>(sums.data()).noalias() =
        all.lazyProduct(shape_weights.segment(first, count).matrix()) *
        (mass > 0.0 ? share / (KernelSource::kPi * mass) : 0.0);
    return std::bit_cast<kernel::AzimuthNode>(sums);
  }

  // Adds four numbers per column to `sums`: i and q by the finer rule, and how much i and q by the coarser rule differ.
  // For a sky, the larger difference and 0 replace the two differences.
  void add_columns(const SampledPiece& piece, const Eigen::ArrayXd& shape_weights, double share,
                   std::span<const double> azimuths, std::span<double> sums) {
    const auto functions = static_cast<Eigen::Index>(sums.size() / DOLP_COLUMN_PARTS);
    if (functions == 0) return;
    const bool has_sky = !data.response;
    const Eigen::Map<const Eigen::MatrixXd> all(azimuths.data(), 2 * functions, shape_weights.size());
    const auto sum_of_rule = [&](std::uint32_t first, std::uint32_t count) -> Eigen::VectorXd {
      const double mass = shape_weights.segment(first, count).sum();
      return all.middleCols(first, count) * shape_weights.segment(first, count).matrix() *
             (mass > 0.0 ? share / (KernelSource::kPi * mass) : 0.0);
    };
    const Eigen::VectorXd fine = sum_of_rule(piece.first, piece.fine);
    const Eigen::VectorXd apart = fine - sum_of_rule(piece.first + piece.fine, piece.coarse);
    for (Eigen::Index k = 0; k < functions; ++k) {
      const auto part = sums.subspan(static_cast<std::size_t>(k) * DOLP_COLUMN_PARTS, DOLP_COLUMN_PARTS);
      part[0] += fine[2 * k];
      part[1] += fine[2 * k + 1];
      part[2] += has_sky ? std::max(std::abs(apart[2 * k]), std::abs(apart[2 * k + 1])) : apart[2 * k];
      part[3] += has_sky ? 0.0 : apart[2 * k + 1];
    }
  }

  kernel::MomentsNode integrate_shape(const SlopeSamples& samples, const KernelSource::ShapeNode& shape,
                                      const SlopeWeights& weights, std::span<const kernel::AzimuthNode> azimuths,
                                      std::span<const double> azimuth_columns, Eigen::ArrayXd& shape_weights,
                                      std::span<double> columns) {
    std::ranges::fill(columns, 0.0);
    const double factor = source.exponent_factor(shape);
    const auto has_facets = [&](const SampledPiece& piece) {
      return factor * source.common_exponent(piece.start / shape.m) < kNoFacets;
    };
    const auto end = std::ranges::partition_point(samples.pieces, has_facets);
    const SampledPiece& last = *(end - 1);
    const auto count = static_cast<Eigen::Index>(last.first + last.fine + last.coarse);
    shape_weights.head(count) = weights.common.head(count) * (-factor * weights.exponent.head(count)).exp();
    kernel::MomentsNode moments{};
    double from = 0.0;
    for (auto piece = samples.pieces.begin(); piece != end; ++piece) {
      const double to = factor * source.common_exponent(piece->end / shape.m);
      const double share = -std::exp(-from) * std::expm1(from - to);
      from = to;
      const auto fine = sum_azimuths(piece->first, piece->fine, shape_weights, share, azimuths);
      const auto coarse = sum_azimuths(piece->first + piece->fine, piece->coarse, shape_weights, share, azimuths);
      add_columns(*piece, shape_weights, share, azimuth_columns, columns);
      const auto apart = [](double a, double b) { return std::abs(a - b); };
      const bool is_steep = piece->end > slope_with_bounces(DOLP_MOST_BOUNCES);
      add_piece(moments,
                {fine.r_i, fine.r_q, fine.albedo, fine.deficit, fine.behind, is_steep ? fine.r_i : 0.0, fine.direct_i,
                 fine.direct_q, std::max(apart(fine.r_i, coarse.r_i), apart(fine.r_q, coarse.r_q)),
                 apart(fine.albedo, coarse.albedo), apart(fine.deficit, coarse.deficit),
                 std::max(apart(fine.direct_i, coarse.direct_i), apart(fine.direct_q, coarse.direct_q)), 0.0});
    }
    return moments;
  }

  // The weights of a width for all slopes and one q. Each rule of a piece is scaled so that its sum is the exact share
  // of the facets on the piece (see sum_azimuths).
  Eigen::ArrayXd scaled_weights(const SlopeSamples& samples, const KernelSource::ShapeNode& shape,
                                const SlopeWeights& weights) {
    const double factor = source.exponent_factor(shape);
    Eigen::ArrayXd scaled = weights.common * (-factor * weights.exponent).exp();
    double from = 0.0;
    for (const SampledPiece& piece : samples.pieces) {
      const double to = factor * source.common_exponent(piece.end / weights.m);
      const double share = -std::exp(-from) * std::expm1(from - to);
      from = to;
      for (const auto& [first, count] :
           {std::pair(piece.first, piece.fine), {piece.first + piece.fine, piece.coarse}}) {
        const double mass = scaled.segment(first, count).sum();
        scaled.segment(first, count) *= mass > 0.0 ? share / (KernelSource::kPi * mass) : 0.0;
      }
    }
    return scaled;
  }

  // Weights of the slopes in the sums of each order: the mean over the sectors, for an elliptic distribution, with the
  // Fourier coefficient of the sector's azimuth.
  OrderWeights order_weights(const SlopeSamples& samples, std::uint32_t shape,
                             std::vector<SlopeWeights>& sector_weights) {
    auto node = std::bit_cast<KernelSource::ShapeNode>(data.shapes[shape]);
    const std::vector<SlopeSector> sectors = slope_sectors(data.slopes[shape], data.orders.sectors);
    OrderWeights weights(is_elliptic(data.slopes[shape]) ? samples.orders : 1, samples.slopes.size());
    sector_weights.resize(sectors.size());
    for (std::size_t i = 0; i < sectors.size(); ++i) {
      node.m = slope_width({.sigma = sectors[i].sigma});
      if (sector_weights[i].m != node.m) sector_weights[i] = slope_weights(samples, node);
      weights.add(scaled_weights(samples, node, sector_weights[i]), sectors[i].azimuth, sectors[i].share);
      weights.steeper += sectors[i].share * source.slope_tail(node, samples.cut);
    }
    return weights;
  }

  void integrate_orders(const SlopeSamples& samples, std::span<const kernel::AzimuthNode> azimuths,
                        std::span<const double> azimuth_columns, double unit_roundoff, std::span<Moments> moments) {
    std::vector<SlopeWeights> sector_weights;
    OrderSums sums;
    SlopeShape known;
    const Bundle& bundle = data.bundles[samples.bundle];
    std::size_t entry = bundle.first_entry;
    for (const std::uint32_t shape : data.bundle_shapes(samples.bundle)) {
      SlopeShape slopes = data.slopes[shape];
      const double azimuth = slopes.azimuth_deg;
      slopes.azimuth_deg = 0.0;  // all azimuths share the sums
      if (!(slopes == known)) {
        sums = order_sums(samples, order_weights(samples, shape, sector_weights), azimuths, azimuth_columns, data);
        sums.evaluations /= static_cast<double>(bundle.count);
        known = slopes;
      }
      moments[entry++] = moments_at_azimuth(sums, data, data.entry(samples.bundle, shape), azimuth, unit_roundoff);
    }
  }
};

SlopeSampling::SlopeSampling(const KernelData& data) : impl_(std::make_unique<Impl>(data)) {}
SlopeSampling::~SlopeSampling() = default;

SlopeSamples SlopeSampling::plan(std::size_t bundle) const {
  const KernelData& data = impl_->data;
  const std::span<const std::uint32_t> shapes = data.bundle_shapes(bundle);
  const MomentsEntry entry = data.entry(bundle, shapes.front());
  const std::vector<kernel::ShapeNode> corners = corner_shapes(data, shapes);
  const std::vector<End> ends = impl_->piece_ends(entry.theta, corners);
  const auto theta = std::bit_cast<KernelSource::ThetaNode>(data.thetas[entry.theta]);
  const auto index = std::bit_cast<KernelSource::IndexNode>(data.indices[entry.index]);
  SlopeSamples samples{.bundle = bundle};
  samples.cut = std::min(corners.front().cut, ends.back().slope);
  std::vector<SampleRequest> requests;
  for (const kernel::ShapeNode& corner : corners) {
    requests.push_back({.all = impl_->source.weight_of_shape(theta, std::bit_cast<KernelSource::ShapeNode>(corner))});
  }
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const KernelSource::Task task = impl_->piece_task(entry.theta, ends, i);
    const KernelSource::Piece piece = impl_->hardest_piece(theta, index, corners, task, requests);
    const int resolving = nodes_at_roots(data, task);
    const int fine = std::min(piece.order + resolving, data.rule_order);
    const int coarse = std::min(impl_->source.coarse_order(piece.order) + resolving, data.rule_order);
    samples.pieces.push_back({ends[i].slope, std::min(ends[i + 1].slope, samples.cut),
                              static_cast<std::uint32_t>(samples.slopes.size()), static_cast<std::uint32_t>(fine),
                              static_cast<std::uint32_t>(coarse), ends[i].direction_piece});
    impl_->add_rule(samples, theta, corners, piece, requests, fine);
    impl_->add_rule(samples, theta, corners, piece, requests, coarse);
  }
  samples.orders = data.orders.highest + 1;
  return samples;
}

void SlopeSampling::append(const SlopeSamples& samples, std::size_t at_once,
                           std::vector<kernel::SlopeNode>& nodes) const {
  const MomentsEntry entry = impl_->data.entry(samples.bundle, impl_->data.bundle_shapes(samples.bundle).front());
  const Pieces& pieces = impl_->data.pieces[entry.theta];
  for (std::size_t order = 0; order < samples.orders; order += at_once) {
    for (const SampledPiece& piece : samples.pieces) {
      for (std::uint32_t i = 0; i < piece.fine + piece.coarse; ++i) {
        const SampledSlope& slope = samples.slopes[piece.first + i];
        nodes.push_back({slope.t, slope.digits, static_cast<double>(entry.theta), static_cast<double>(entry.index),
                         static_cast<double>(pieces.most_nodes[piece.direction_piece]), i < piece.fine ? 0.0 : 1.0,
                         static_cast<double>(order)});
      }
    }
  }
}

void SlopeSampling::integrate(const SlopeSamples& samples, const SampledAzimuths& sampled, std::size_t first,
                              double unit_roundoff, std::span<Moments> moments) const {
  const auto azimuths = std::span(sampled.nodes).subspan(first, samples.nodes());
  const auto azimuth_columns =
      std::span(sampled.columns).subspan(first * sampled.per_slope, azimuths.size() * sampled.per_slope);
  const KernelData& data = impl_->data;
  double evaluations = 0.0;
  for (const kernel::AzimuthNode& azimuth : azimuths) evaluations += azimuth.evaluations;
  if (samples.orders > 1) {
    impl_->integrate_orders(samples, azimuths, azimuth_columns, unit_roundoff, moments);
    return;
  }
  SlopeWeights weights;
  Eigen::ArrayXd shape_weights(static_cast<Eigen::Index>(samples.slopes.size()));
  std::vector<double> columns(column_sums(data));
  const Bundle& bundle = data.bundles[samples.bundle];
  std::size_t position = bundle.first_entry;
  for (const std::uint32_t shape : data.bundle_shapes(samples.bundle)) {
    const MomentsEntry entry = data.entry(samples.bundle, shape);
    const auto node = std::bit_cast<KernelSource::ShapeNode>(data.shapes[shape]);
    if (node.m != weights.m) weights = impl_->slope_weights(samples, node);
    kernel::MomentsNode sums =
        impl_->integrate_shape(samples, node, weights, azimuths, azimuth_columns, shape_weights, columns);
    sums.deficit += data.thetas[entry.theta].c * impl_->source.slope_tail(node, samples.cut);
    sums.evaluations = evaluations / static_cast<double>(bundle.count);
    moments[position++] = moments_from_kernel(sums, data, entry, unit_roundoff, columns);
  }
}

void SlopeSampling::compute(std::size_t bundle, CpuKernel& kernel, double unit_roundoff,
                            std::span<Moments> moments) const {
  const SlopeSamples samples = plan(bundle);
  std::vector<kernel::SlopeNode> slopes;
  append(samples, 1, slopes);
  SampledAzimuths azimuths(slopes.size(), impl_->data);
  for (std::size_t i = 0; i < slopes.size(); ++i)
    azimuths.nodes[i] = kernel.azimuths(slopes[i], azimuths.slope_columns(i));
  integrate(samples, azimuths, 0, unit_roundoff, moments);
}

}  // namespace dolp
