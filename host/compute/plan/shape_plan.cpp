#include "plan/shape_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "model/chebyshev.hpp"
#include "model/choices.hpp"
#include "model/response_basis.hpp"
#include "plan/constants.hpp"

namespace dolp {
namespace {

/// Estimated interpolation error of each column of `values`: the sum of the omitted Chebyshev coefficients. The
/// estimate assumes that the omitted coefficients fall as fast as the last known ones. `coefficients`: see ShapeAxis.
Eigen::RowVectorXd tails(const Eigen::MatrixXd& coefficients, const RowMajor& values) {
  if (coefficients.size() == 0) return Eigen::RowVectorXd::Zero(values.cols());
  const Eigen::MatrixXd sizes = (coefficients.bottomRows(2 * kLastShapeCoefficients) * values).cwiseAbs();
  const Eigen::RowVectorXd before = sizes.topRows(kLastShapeCoefficients).colwise().maxCoeff();
  const Eigen::RowVectorXd last = sizes.bottomRows(kLastShapeCoefficients).colwise().maxCoeff();
  Eigen::RowVectorXd bounds(values.cols());
  for (Eigen::Index i = 0; i < bounds.size(); ++i) {
    const double fall = before[i] > 0.0 ? std::min(last[i] / before[i], kSlowestShapeFall) : kSlowestShapeFall;
    bounds[i] = kShapeTail * last[i] / (1.0 - fall);
  }
  return bounds;
}

constexpr std::array kColumnParts = {&ColumnMoments::i, &ColumnMoments::q};
constexpr auto kPartsOfAColumn = static_cast<std::ptrdiff_t>(kColumnParts.size());

double column_bound(const ColumnMoments& column, double ColumnMoments::*part) {
  return column.error + std::max(std::abs(column.i_apart), std::abs(column.q_apart)) +
         column.relative_error * std::abs(column.*part);
}

std::span<const MomentMember> interpolated_members(const ShapePlan& plan) {
  return std::span(kMomentMembers).first(kMomentMembers.size() - (plan.nodes.wants_direct ? 0 : kDirectMembers));
}

struct SlopeAxes {
  std::vector<double> sigma, q;
};

/// The values of sigma and q if the bundles of the group have all pairs of them; otherwise nullopt.
std::optional<SlopeAxes> product_axes(const MomentsRequest& group) {
  std::vector<SlopeShape> shapes;
  for (const std::uint32_t i : group.bundle_shapes(group.bundles.front())) shapes.push_back(group.shapes[i]);
  SlopeAxes axes;
  for (const SlopeShape& shape : shapes) {
    if (axes.sigma.empty() || axes.sigma.back() != shape.sigma) axes.sigma.push_back(shape.sigma);
    if (axes.sigma.size() == 1) axes.q.push_back(shape.q);
  }
  return shape_product(axes.sigma, axes.q) == shapes ? std::optional(std::move(axes)) : std::nullopt;
}

/// How to interpolate over x, which is sigma or q. The moments are analytic functions of ln(x - origin), up to the
/// distance `strip` from the real axis. A larger `strip` needs fewer nodes. For q, the origin is 1 or, if the moments
/// depend on a finite mean slope, 1.5. Slopes have no density at q <= 1, and an infinite mean at q <= 1.5.
struct ShapeParameter {
  double origin = 0.0;
  double strip = 1.0;
};

constexpr double kGrazing_deg = 89.9;

bool is_grazing(double theta_deg) { return theta_deg > kGrazing_deg; }

double nodes_needed(const ShapeParameter& parameter, double half_length, double digits) {
  const double per_digit = std::log(10.0) / std::asinh(parameter.strip / half_length);
  return std::max(std::ceil(kFirstShapeNodes + digits * per_digit), kLeastShapeNodes);
}

ShapeAxis without_interpolation(const std::vector<double>& values) {
  const auto count = static_cast<Eigen::Index>(values.size());
  return {values, RowMajor::Identity(count, count), {}};
}

ShapeParameter sigma_parameter(Distribution distribution) {
  return {0.0, distribution == Distribution::kGaussian ? 0.78 : 1.15};
}

/// How to interpolate over q. `theta_deg`: the zenith of one direction; either all are grazing, or none is.
ShapeParameter q_parameter(const MomentsRequest& request, double theta_deg, const std::vector<double>& q) {
  const bool needs_mean_slope =
      request.masking == Masking::kSmith || (!keeps_projected_area(request.masking) && is_grazing(theta_deg));
  const bool has_mean_slope = request.distribution == Distribution::kCauchy && std::ranges::min(q) > 1.5;
  return {needs_mean_slope && has_mean_slope ? 1.5 : 1.0, 1.45};
}

struct Range {
  double least, largest;
};

Range range_of_values(const std::vector<double>& values) {
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  return {*least, *largest};
}

/// A wider range with ends on a coarse scale. So different parts of a list mostly have the same nodes.
Range rounded_range(const ShapeParameter& parameter, const std::vector<double>& values) {
  constexpr double kStep = 0.25;
  const Range range = range_of_values(values);
  if (range.least == range.largest) return range;
  const auto rounded = [&](double value, double round(double)) {
    return parameter.origin + std::exp(kStep * round(std::log(value - parameter.origin) / kStep));
  };
  return {rounded(range.least, std::floor), rounded(range.largest, std::ceil)};
}

/// Nodes in `range` from which `values` are interpolated with `digits` correct digits. No interpolation if there are
/// fewer than `least_gain` values per node.
ShapeAxis shape_axis(const ShapeParameter& parameter, const Range& range, const std::vector<double>& values,
                     double digits, double least_gain) {
  const double start = std::log(range.least - parameter.origin);
  const double end = std::log(range.largest - parameter.origin);
  const double half_length = 0.5 * (end - start);
  if (half_length <= 0.0) return {{range.least}, RowMajor::Ones(1, static_cast<Eigen::Index>(values.size())), {}};
  const double count = nodes_needed(parameter, half_length, digits);
  if (!(count * least_gain <= static_cast<double>(values.size()))) return without_interpolation(values);

  ShapeAxis axis;
  const auto nodes = static_cast<Eigen::Index>(count);
  const std::vector<double> points = lobatto_points(nodes);
  for (const double point : points) {
    axis.nodes.push_back(parameter.origin + std::exp(0.5 * (start + end) + half_length * point));
  }
  axis.nodes.front() = range.largest;
  axis.nodes.back() = range.least;
  axis.weights.resize(nodes, static_cast<Eigen::Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double x = (std::log(values[i] - parameter.origin) - 0.5 * (start + end)) / half_length;
    axis.weights.col(static_cast<Eigen::Index>(i)) = cardinal_values(points, std::clamp(x, -1.0, 1.0)).transpose();
  }
  axis.coefficients = chebyshev_coefficients(nodes);
  return axis;
}

// Zeniths at which panels end. Toward 90 degrees the moments change with 90 degrees - theta, so the panels halve there.
// With masking `v-cavity` the moments are not analytic at 45 degrees, where breakpoints of the slope axis cross (90
// degrees - theta and 30 degrees + theta / 3). Beyond the last end nothing is interpolated.
constexpr std::array kPanelEnds_deg = {0.0, 22.5, 45.0, 67.5, 78.75, 84.375, 87.1875};
// The nearest singularity of a panel is at 90 degrees, as far away as the panel is long.
constexpr ShapeParameter kInPanel = {.origin = 0.0, .strip = 2.83};

std::size_t panel_at(double theta_deg) {
  const auto end = std::ranges::upper_bound(kPanelEnds_deg, theta_deg);
  return std::min<std::size_t>(static_cast<std::size_t>(end - kPanelEnds_deg.begin()), kPanelEnds_deg.size() - 1) - 1;
}

double middle_deg(std::size_t panel) { return 0.5 * (kPanelEnds_deg[panel] + kPanelEnds_deg[panel + 1]); }
double half_length_deg(std::size_t panel) { return 0.5 * (kPanelEnds_deg[panel + 1] - kPanelEnds_deg[panel]); }

}  // namespace

std::vector<std::vector<std::size_t>> interpolation_groups(const MomentsRequest& request) {
  // Elliptic shapes share their slope samples.
  if (!request.may_interpolate || request.is_scattered || request.has_elliptic_shapes()) return {};
  std::map<std::tuple<bool, std::uint32_t, std::uint32_t>, std::vector<std::size_t>> by_shapes;
  for (std::size_t i = 0; i < request.bundles.size(); ++i) {
    const Bundle& bundle = request.bundles[i];
    const bool is_apart = !keeps_projected_area(request.masking) && is_grazing(request.theta_deg[bundle.direction]);
    by_shapes[{is_apart, bundle.first, bundle.count}].push_back(i);
  }
  std::vector<std::vector<std::size_t>> groups;
  for (auto& [shapes, bundles] : by_shapes) groups.push_back(std::move(bundles));
  return groups;
}

std::optional<ShapePlan> shape_plan(const MomentsRequest& request) {
  const std::optional<SlopeAxes> axes = product_axes(request);
  if (!axes) return std::nullopt;
  const double digits = kExtraShapeDigits - std::log10(request.tolerance);
  ShapePlan plan;
  const auto axis = [&](const ShapeParameter& parameter, const std::vector<double>& values) {
    return shape_axis(parameter, range_of_values(values), values, digits, kLeastAxisGain);
  };
  plan.sigma = axis(sigma_parameter(request.distribution), axes->sigma);
  const double theta_deg = request.theta_deg[request.bundles.front().direction];
  plan.q = axis(q_parameter(request, theta_deg, axes->q), axes->q);
  std::vector<SlopeShape> nodes = shape_product(plan.sigma.nodes, plan.q.nodes);
  if (request.bundles.front().count < kLeastShapeGain * nodes.size()) return std::nullopt;
  plan.nodes = request;
  plan.nodes.tolerance = request.finer_tolerance(kShapeNodeTolerance);
  plan.nodes.set_shapes(std::move(nodes));
  return plan;
}

ShapeBlock shape_block(const ShapePlan& plan, std::span<const Moments> nodes) {
  const auto sigma_nodes = static_cast<Eigen::Index>(plan.sigma.nodes.size());
  const auto q_nodes = static_cast<Eigen::Index>(plan.q.nodes.size());
  const std::size_t columns = nodes.front().columns.size();
  const auto moments = static_cast<Eigen::Index>(interpolated_members(plan).size() + kPartsOfAColumn * columns);
  ShapeBlock block{RowMajor(sigma_nodes, moments * q_nodes), RowMajor(sigma_nodes, moments * q_nodes)};
  Eigen::Index first = 0;
  const auto add = [&](const auto& node_value, const auto& node_bound) {
    RowMajor values(sigma_nodes, q_nodes), bounds(sigma_nodes, q_nodes);
    std::ranges::transform(nodes, values.data(), node_value);
    std::ranges::transform(nodes, bounds.data(), node_bound);
    bounds.rowwise() += tails(plan.sigma.coefficients, values);
    bounds.colwise() += tails(plan.q.coefficients, values.transpose()).transpose();
    block.values.middleCols(first, q_nodes) = values;
    block.bounds.middleCols(first, q_nodes) = bounds;
    first += q_nodes;
  };
  for (const auto& [value, error] : interpolated_members(plan)) add(value, error);
  for (std::size_t k = 0; k < columns; ++k) {
    for (double ColumnMoments::*part : kColumnParts) {
      add([&](const Moments& node) { return node.columns[k].*part; },
          [&](const Moments& node) { return column_bound(node.columns[k], part); });
    }
  }
  return block;
}

void interpolate(const ShapePlan& plan, const ShapeBlock& block, const ShapeRange& range, std::span<Moments> moments) {
  const auto own_weights = [](const ShapeAxis& axis, std::size_t first, std::size_t count) {
    return axis.weights.middleCols(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(count));
  };
  const auto sigma_weights = own_weights(plan.sigma, range.first_sigma, range.sigmas).transpose();
  const auto q_weights = own_weights(plan.q, range.first_q, range.qs);
  const RowMajor values = weighted_sums(sigma_weights, block.values);
  const RowMajor bounds = weighted_sums(sigma_weights.cwiseAbs(), block.bounds);
  const Eigen::Index q_nodes = q_weights.rows();
  Eigen::Index first = 0;
  const auto next = [&](const auto& take) {
    const RowMajor value = weighted_sums(values.middleCols(first, q_nodes), q_weights);
    const RowMajor bound = weighted_sums(bounds.middleCols(first, q_nodes), q_weights.cwiseAbs());
    for (std::size_t i = 0; i < moments.size(); ++i) take(moments[i], value.data()[i], bound.data()[i]);
    first += q_nodes;
  };
  for (const auto& [member, error] : interpolated_members(plan)) {
    next([&](Moments& entry, double value, double bound) {
      entry.*member = value;
      entry.*error = bound;
    });
  }
  const auto columns = static_cast<std::size_t>((values.cols() - first) / (q_nodes * kPartsOfAColumn));
  for (Moments& entry : moments) entry.columns.assign(columns, {});
  for (std::size_t k = 0; k < columns; ++k) {
    for (double ColumnMoments::*part : kColumnParts) {
      next([&](Moments& entry, double value, double bound) {
        entry.columns[k].*part = value;
        entry.columns[k].error = std::max(entry.columns[k].error, bound);
      });
    }
  }
}

bool PointPlan::reaches(double theta_deg) { return theta_deg <= kPanelEnds_deg.back(); }

std::optional<PointPlan> point_plan(const MomentsRequest& points) {
  const std::vector<Bundle>& bundles = points.bundles;
  if (!points.is_scattered || !points.may_interpolate || bundles.size() < kLeastPoints || points.has_elliptic_shapes())
    return std::nullopt;
  const double digits = kExtraShapeDigits - std::log10(kResponseTolerance * points.tolerance);
  PointPlan plan;
  const auto axis = [&](const ShapeParameter& parameter, const std::vector<double>& values) {
    return shape_axis(parameter, rounded_range(parameter, values), values, digits, 0.0);
  };
  std::vector<double> sigma, q;
  for (const SlopeShape& shape : points.shapes) {
    sigma.push_back(shape.sigma);
    q.push_back(shape.q);
  }
  plan.shapes.sigma = axis(sigma_parameter(points.distribution), sigma);
  plan.shapes.q = axis(q_parameter(points, kPanelEnds_deg.front(), q), q);
  plan.in_panel = lobatto_points(static_cast<Eigen::Index>(nodes_needed(kInPanel, 1.0, digits)));
  plan.coefficients = chebyshev_coefficients(static_cast<Eigen::Index>(plan.in_panel.size()));
  MomentsRequest& nodes = plan.shapes.nodes = points.without_entries();
  nodes.is_scattered = false;
  nodes.optics = {points.basis->reference()};
  nodes.shapes = shape_product(plan.shapes.sigma.nodes, plan.shapes.q.nodes);
  for (std::size_t panel = 0; panel + 1 < kPanelEnds_deg.size(); ++panel) {
    for (const double x : plan.in_panel) nodes.theta_deg.push_back(middle_deg(panel) + half_length_deg(panel) * x);
  }
  nodes.set_grid();
  std::size_t different = 0;
  for (std::size_t i = 0; i < bundles.size(); ++i) {
    const bool is_new = i == 0 || !bundles[i].has_geometry(bundles[i - 1]);
    if (is_new && PointPlan::reaches(points.theta_deg[bundles[i].direction])) different += bundles[i].count;
  }
  if (different < kLeastPointGain * nodes.size()) return std::nullopt;
  return plan;
}

std::vector<ShapeBlock> panel_blocks(const PointPlan& plan, std::span<const Moments> nodes) {
  const auto columns = static_cast<Eigen::Index>(nodes.front().columns.size());
  const auto moments = static_cast<Eigen::Index>(interpolated_members(plan.shapes).size()) + kPartsOfAColumn * columns;
  const auto directions = static_cast<Eigen::Index>(plan.in_panel.size());
  const auto sigmas = static_cast<Eigen::Index>(plan.shapes.sigma.nodes.size());
  const auto qs = static_cast<Eigen::Index>(plan.shapes.q.nodes.size());
  std::vector<ShapeBlock> panels(kPanelEnds_deg.size() - 1);
  for (ShapeBlock& panel : panels) {
    RowMajor bounds(directions * sigmas * qs, moments);
    panel.values.resize(bounds.rows(), moments);
    for (Eigen::Index row = 0; row < bounds.rows(); ++row, nodes = nodes.subspan(1)) {
      Eigen::Index moment = 0;
      const auto add = [&](double value, double bound) {
        panel.values(row, moment) = value;
        bounds(row, moment++) = bound;
      };
      for (const auto& [value, error] : interpolated_members(plan.shapes))
        add(nodes.front().*value, nodes.front().*error);
      for (const ColumnMoments& column : nodes.front().columns) {
        for (double ColumnMoments::*part : kColumnParts) add(column.*part, column_bound(column, part));
      }
    }
    const auto add_tails = [&](const Eigen::MatrixXd& coefficients, Eigen::Index outer, Eigen::Index count) {
      const Eigen::Index inner = bounds.size() / (outer * count);
      for (Eigen::Index i = 0; i < outer; ++i) {
        const RowMajor values = Eigen::Map<const RowMajor>(panel.values.data() + i * count * inner, count, inner);
        Eigen::Map<RowMajor>(bounds.data() + i * count * inner, count, inner).rowwise() += tails(coefficients, values);
      }
    };
    add_tails(plan.coefficients, 1, directions);
    add_tails(plan.shapes.sigma.coefficients, directions, sigmas);
    add_tails(plan.shapes.q.coefficients, directions * sigmas, qs);
    const auto by_direction = Eigen::Map<const RowMajor>(bounds.data(), directions, sigmas * qs * moments);
    panel.bounds = by_direction.colwise().maxCoeff().reshaped<Eigen::RowMajor>(sigmas * qs, moments);
  }
  return panels;
}

Moments interpolate(const PointPlan& plan, std::span<const ShapeBlock> panels, double theta_deg, std::size_t shape) {
  const std::size_t number = panel_at(theta_deg);
  const ShapeBlock& panel = panels[number];
  const Eigen::RowVectorXd of_zeniths =
      cardinal_values(plan.in_panel, (theta_deg - middle_deg(number)) / half_length_deg(number));
  const auto own = static_cast<Eigen::Index>(shape);
  const RowMajor of_shapes = plan.shapes.sigma.weights.col(own) * plan.shapes.q.weights.col(own).transpose();
  const auto shape_row = of_shapes.reshaped<Eigen::RowMajor>().transpose();
  const RowMajor of_nodes = of_zeniths.transpose() * shape_row;
  const Eigen::RowVectorXd values = of_nodes.reshaped<Eigen::RowMajor>().transpose() * panel.values;
  const Eigen::RowVectorXd bounds = of_zeniths.cwiseAbs().sum() * (shape_row.cwiseAbs() * panel.bounds);
  Moments moments;
  Eigen::Index moment = 0;
  for (const auto& [member, error] : interpolated_members(plan.shapes)) {
    moments.*member = values(moment);
    moments.*error = bounds(moment++);
  }
  moments.columns.resize(static_cast<std::size_t>((values.cols() - moment) / kPartsOfAColumn));
  for (ColumnMoments& column : moments.columns) {
    for (double ColumnMoments::*part : kColumnParts) {
      column.*part = values(moment);
      column.error = std::max(column.error, bounds(moment++));
    }
  }
  return moments;
}

}  // namespace dolp
