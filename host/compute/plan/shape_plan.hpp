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

/// Groups of directions that can share one interpolation over slope distributions. If the masking is none or integral,
/// grazing directions are a group of their own, because their moments depend on the mean slope.
std::vector<std::vector<std::size_t>> split_grazing_directions(const MomentsRequest& request);

struct ShapeAxis {
  std::vector<double> nodes;     ///< values at which moments are computed; without interpolation all values
  RowMajor weights;              ///< for each node a row of weights, one for each value of the axis
  Eigen::MatrixXd coefficients;  ///< converts moments at nodes to Chebyshev coefficients; empty without interpolation
  bool is_interpolated() const { return coefficients.size() > 0; }
};

struct ShapePlan {
  ShapeAxis sigma;
  ShapeAxis q;
  MomentsRequest nodes;  ///< the request with sigma.nodes and q.nodes as axes, and with a smaller tolerance

  std::size_t nodes_of_a_direction() const { return sigma.nodes.size() * q.nodes.size(); }
};

/// Plans the interpolation for the directions of one group of split_grazing_directions(). Returns nullopt if it would
/// save little or is impossible, for example if the request wants only some pairs of sigma and q of a direction.
std::optional<ShapePlan> shape_plan(const MomentsRequest& request);

/// The known moments of one direction and index. `bounds` has their error bounds and the estimated errors of
/// interpolation. Shape: nodes of sigma x (moments x nodes of q). The moments are those of kMomentMembers, without the
/// direct emission if the request does not want it, then i and q of each column.
struct ShapeBlock {
  RowMajor values, bounds;
  bool is_empty() const { return values.size() == 0; }
};

/// `nodes`: moments at all nodes of the plan for one direction and index.
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

/// Interpolation of responses over zenith, sigma and q for a list of many points. The zeniths up to a limit are divided
/// into panels.
struct PointPlan {
  std::vector<double> in_panel;  ///< nodes of a panel, on [-1, 1]
  Eigen::MatrixXd coefficients;  ///< converts moments at the nodes of a panel to Chebyshev coefficients
  ShapePlan shapes;              ///< has a column of weights for each point, and the nodes of all panels as directions

  static bool reaches(double theta_deg);  ///< true if points at this zenith can be interpolated
};

/// Returns nullopt if interpolation would save little or is impossible. `points`: a list with a basis.
std::optional<PointPlan> point_plan(const MomentsRequest& points);

/// The known moments of each panel. `nodes`: moments at all nodes of the plan. Shape: `values` has a row for each node
/// of the panel. `bounds` has a row for each pair of a node of sigma and a node of q, with the largest bounds of all
/// zeniths. The columns are the moments, ordered as in ShapeBlock.
std::vector<ShapeBlock> panel_blocks(const PointPlan& plan, std::span<const Moments> nodes);

/// The moments of a point of the plan's list. `point`: its number; theta_deg: its zenith.
Moments interpolate(const PointPlan& plan, std::span<const ShapeBlock> panels, double theta_deg, std::size_t point);

}  // namespace dolp
