#include "plan/shape_plan.hpp"
#include "model/choices.hpp"
#include "model/moments.hpp"
#include "model/slopes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace dolp {
namespace {

constexpr double kNodeTolerance = 0.125;  // of the request's tolerance: bounds grow by the interpolant's weights
constexpr double kExtraDigits = 1.0;       // of the interpolation
constexpr std::size_t kLeastGain = 2;      // entries of a slab for each node
constexpr double kTail = 3.0;         // error bound over the largest of the last coefficients, where these fall fast
constexpr double kSlowestFall = 0.9;  // of the last coefficients over those before them
constexpr Eigen::Index kLastCoefficients = 3;

constexpr std::uint32_t kNoSlab = std::numeric_limits<std::uint32_t>::max();
constexpr Eigen::Index kQuantities = 4;

using Values = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Four = Eigen::Array4d;

/// The distinct values of a parameter, and the position of each shape's.
struct Distincts {
  std::vector<double> values;
  std::vector<std::uint32_t> position_of;
};

Distincts distinct(const std::vector<SlopeShape>& shapes, double SlopeShape::*parameter) {
  Distincts result;
  std::map<double, std::uint32_t> positions;
  for (const SlopeShape& shape : shapes) {
    const auto [found, is_new] =
        positions.try_emplace(shape.*parameter, static_cast<std::uint32_t>(result.values.size()));
    if (is_new) result.values.push_back(shape.*parameter);
    result.position_of.push_back(found->second);
  }
  return result;
}

/// A request for other entries of the same lists.
MomentsRequest request_like(const MomentsRequest& request) {
  MomentsRequest other = request;
  other.entries.clear();
  return other;
}

double node_tolerance(const MomentsRequest& request) {
  const double wanted = kNodeTolerance * request.tolerance;
  return request.precision == Precision::kDouble ? wanted
                                                 : std::max(wanted, std::min(kLeastFloatTolerance, request.tolerance));
}

/// Sorts the entries of a request into slabs, and those of slabs with few entries out.
class SlabSorter {
 public:
  explicit SlabSorter(const MomentsRequest& request) : request_(request) {
    const std::size_t slabs = request.theta_deg.size() * request.indices.size();
    count_.resize(slabs);
    for (const MomentsEntry& entry : request.entries) ++count_[slab_of(entry)];
  }

  std::size_t largest() const { return *std::ranges::max_element(count_); }

  void sort_into(ShapePlan& plan, std::size_t least_entries) const {
    std::vector<std::uint32_t> number(count_.size(), kNoSlab);
    for (std::uint32_t i = 0; i < request_.entries.size(); ++i) {
      const MomentsEntry& entry = request_.entries[i];
      const std::size_t slab = slab_of(entry);
      if (count_[slab] < least_entries) {
        plan.direct_entries.push_back(i);
        plan.direct.entries.push_back(entry);
        continue;
      }
      if (number[slab] == kNoSlab) {
        number[slab] = static_cast<std::uint32_t>(plan.slabs.size());
        plan.slabs.emplace_back().entries.reserve(count_[slab]);
      }
      plan.slabs[number[slab]].entries.push_back(i);
    }
  }

 private:
  std::size_t slab_of(const MomentsEntry& entry) const {
    return static_cast<std::size_t>(entry.theta) * request_.indices.size() + entry.index;
  }

  const MomentsRequest& request_;
  std::vector<std::uint32_t> count_;
};

void add_nodes(ShapePlan& plan, const MomentsRequest& request) {
  for (const double sigma : plan.sigma.nodes) {
    for (const double q : plan.q.nodes) plan.nodes.shapes.push_back({sigma, q});
  }
  for (const Slab& slab : plan.slabs) {
    MomentsEntry node = request.entries[slab.entries.front()];
    for (node.shape = 0; node.shape < plan.nodes.shapes.size(); ++node.shape) plan.nodes.entries.push_back(node);
  }
}

/// One of the four moments, or its bound, at the nodes of a slab: sigma x q.
Values at_nodes(const ShapePlan& plan, std::span<const Moments> nodes, double Moments::*quantity) {
  Values values(static_cast<Eigen::Index>(plan.sigma.nodes.size()), static_cast<Eigen::Index>(plan.q.nodes.size()));
  for (Eigen::Index i = 0; i < values.size(); ++i) values.data()[i] = nodes[static_cast<std::size_t>(i)].*quantity;
  return values;
}

/// Error bounds of the interpolation of each column of `values`, given at the axis's nodes: the coefficients left out,
/// if they go on falling as the last ones do.
Eigen::RowVectorXd tails(const ShapeAxis& axis, const Values& values) {
  if (!axis.is_interpolated()) return Eigen::RowVectorXd::Zero(values.cols());
  const Eigen::MatrixXd sizes = (axis.coefficients.bottomRows(2 * kLastCoefficients) * values).cwiseAbs();
  const Eigen::RowVectorXd before = sizes.topRows(kLastCoefficients).colwise().maxCoeff();
  const Eigen::RowVectorXd last = sizes.bottomRows(kLastCoefficients).colwise().maxCoeff();
  Eigen::RowVectorXd bounds(values.cols());
  for (Eigen::Index i = 0; i < bounds.size(); ++i) {
    const double fall = before[i] > 0.0 ? std::min(last[i] / before[i], kSlowestFall) : kSlowestFall;
    bounds[i] = kTail * last[i] / (1.0 - fall);
  }
  return bounds;
}

constexpr std::array<double Moments::*, kQuantities> kMoments = {&Moments::r_i, &Moments::r_q, &Moments::albedo,
                                                                 &Moments::deficit};
constexpr std::array<double Moments::*, kQuantities> kBounds = {&Moments::r_i_error, &Moments::r_q_error,
                                                                &Moments::albedo_error, &Moments::deficit_error};

}  // namespace

std::optional<ShapePlan> shape_plan(const MomentsRequest& request) {
  const std::size_t entries = request.entries.size();
  if (!request.may_interpolate || entries == 0) return std::nullopt;
  // Scattered points have directions or indices of their own,
  if (request.theta_deg.size() * request.indices.size() * kLeastGain > entries) return std::nullopt;
  const SlabSorter sorter(request);
  const double digits = kExtraDigits - std::log10(request.tolerance);
  const Distincts sigma = distinct(request.shapes, &SlopeShape::sigma);
  const Distincts q = distinct(request.shapes, &SlopeShape::q);
  ShapePlan plan;
  plan.sigma = shape_axis(sigma_parameter(request.distribution), sigma.values, digits);
  plan.q = shape_axis(q_parameter(request.distribution, request.masking), q.values, digits);
  // or slope distributions that are no grid.
  const std::size_t least_entries =
      std::max(kLeastGain * plan.nodes_of_a_slab(), sigma.values.size() * plan.q.nodes.size());
  if (sorter.largest() < least_entries) return std::nullopt;
  plan.sigma_of = sigma.position_of;
  plan.q_of = q.position_of;
  plan.direct = request_like(request);
  plan.nodes = request_like(request);
  plan.nodes.tolerance = node_tolerance(request);
  plan.nodes.shapes.clear();
  sorter.sort_into(plan, least_entries);
  add_nodes(plan, request);
  return plan;
}

std::vector<Moments> interpolated(const ShapePlan& plan, const Slab& slab, const MomentsRequest& request,
                                  std::span<const Moments> nodes) {
  const Eigen::MatrixXd sigma_sizes = plan.sigma.cardinal.cwiseAbs();
  // For each sigma of the request and each node of q the four moments and their four bounds.
  const Eigen::Index sigmas = plan.sigma.cardinal.rows();
  const Eigen::Index q_nodes = plan.q.cardinal.cols();
  std::vector<std::array<Four, 2>> columns(static_cast<std::size_t>(sigmas * q_nodes));
  for (Eigen::Index k = 0; k < kQuantities; ++k) {
    const auto quantity = static_cast<std::size_t>(k);
    const Values at = at_nodes(plan, nodes, kMoments[quantity]);
    Values bound = at_nodes(plan, nodes, kBounds[quantity]);
    bound.rowwise() += tails(plan.sigma, at);
    bound.colwise() += tails(plan.q, at.transpose()).transpose();
    const Values values = plan.sigma.cardinal * at;
    const Values bounds = sigma_sizes * bound;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      columns[i][0][k] = values.data()[i];
      columns[i][1][k] = bounds.data()[i];
    }
  }
  double evaluations = 0.0;
  for (const Moments& node : nodes) evaluations += node.evaluations;
  evaluations /= static_cast<double>(slab.entries.size());
  const Values q_rows = plan.q.cardinal;
  std::vector<Moments> moments(slab.entries.size());
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const std::uint32_t shape = request.entries[slab.entries[i]].shape;
    const std::array<Four, 2>* const row = columns.data() + plan.sigma_of[shape] * q_nodes;
    const double* const weights = q_rows.row(plan.q_of[shape]).data();
    Four value = Four::Zero();
    Four bound = Four::Zero();
    for (Eigen::Index j = 0; j < q_nodes; ++j) {
      value += weights[j] * row[j][0];
      bound += std::abs(weights[j]) * row[j][1];
    }
    for (std::size_t k = 0; k < kQuantities; ++k) {
      moments[i].*kMoments[k] = value[static_cast<Eigen::Index>(k)];
      moments[i].*kBounds[k] = bound[static_cast<Eigen::Index>(k)];
    }
    moments[i].evaluations = evaluations;
  }
  return moments;
}

}  // namespace dolp
