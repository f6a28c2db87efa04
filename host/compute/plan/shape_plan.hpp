// Interpolation over slope distributions: moments of one direction and index are analytic in ln(sigma) and ln(q - 1),
// so a few Chebyshev nodes with a tighter tolerance suffice.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "model/choices.hpp"
#include "model/moments.hpp"
#include "plan/weighted_sums.hpp"

namespace dolp {

/// Groups of bundles that can share one interpolation over slope distributions, as positions in the request: those with
/// the same slope distributions. If the masking is none or integral, grazing directions are groups of their own,
/// because their moments depend on the mean slope. Empty if the request cannot be interpolated.
std::vector<std::vector<std::size_t>> interpolation_groups(const MomentsRequest& request);

struct ShapeAxis {
  std::vector<double> nodes;     ///< values at which moments are computed; without interpolation all values
  RowMajor weights;              ///< for each node a row of weights, one for each value of the axis
  Eigen::MatrixXd coefficients;  ///< converts moments at nodes to Chebyshev coefficients; empty without interpolation
  bool is_interpolated() const { return coefficients.size() > 0; }
};

struct ShapePlan {
  ShapeAxis sigma;
  ShapeAxis q;
  /// The request with a smaller tolerance, and with all pairs of sigma.nodes and q.nodes in each bundle.
  MomentsRequest nodes;
};

/// Plans the interpolation for a request that has the bundles of one group. Returns nullopt if it would save little, or
/// if the bundles lack some pairs of sigma and q.
std::optional<ShapePlan> shape_plan(const MomentsRequest& request);

/// The known moments of a bundle. `bounds` has their error bounds and the estimated errors of
/// interpolation. Shape: nodes of sigma x (moments x nodes of q). The moments are those of kMomentMembers, without the
/// direct emission if the request does not want it, then i and q of each column.
struct ShapeBlock {
  RowMajor values, bounds;
  bool is_empty() const { return values.size() == 0; }
};

/// `nodes`: moments at all nodes of the plan for one bundle.
ShapeBlock shape_block(const ShapePlan& plan, std::span<const Moments> nodes);

/// Some neighbouring values of sigma and q: `sigmas` values from number `first_sigma`, and so on.
struct ShapeRange {
  std::size_t first_sigma = 0;
  std::size_t sigmas = 0;
  std::size_t first_q = 0;
  std::size_t qs = 0;
};

/// Interpolates the moments of a block to a range of sigma and q. The error bound is the sum of |weight| * bound over
/// the nodes. Shape: `moments` has range.sigmas x range.qs elements.
void interpolate(const ShapePlan& plan, const ShapeBlock& block, const ShapeRange& range, std::span<Moments> moments);

/// Interpolation of responses over zenith, sigma and q for many bundles of one entry. The zeniths up to a limit are
/// divided into panels.
struct PointPlan {
  std::vector<double> in_panel;  ///< nodes of a panel, on [-1, 1]
  Eigen::MatrixXd coefficients;  ///< converts moments at the nodes of a panel to Chebyshev coefficients
  ShapePlan shapes;  ///< has a column of weights for each of the request's shapes; its directions are all panels' nodes

  static bool reaches(double theta_deg);  ///< true if points at this zenith can be interpolated
};

/// Returns nullopt if interpolation would save little or is impossible. `points`: a request with a basis.
std::optional<PointPlan> point_plan(const MomentsRequest& points);

/// The known moments of each panel. `nodes`: moments at all nodes of the plan. Shape: `values` has a row for each node
/// of the panel. `bounds` has a row for each pair of a node of sigma and a node of q, with the largest bounds of all
/// zeniths. The columns are the moments, ordered as in ShapeBlock.
std::vector<ShapeBlock> panel_blocks(const PointPlan& plan, std::span<const Moments> nodes);

/// The moments of an entry. `shape`: position of its slope distribution in MomentsRequest::shapes.
Moments interpolate(const PointPlan& plan, std::span<const ShapeBlock> panels, double theta_deg, std::size_t shape);

}  // namespace dolp
