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

namespace dolp {

/// Groups of directions that can share one interpolation over slope distributions. Grazing directions are one group.
std::vector<std::vector<std::size_t>> split_grazing_directions(const MomentsRequest& request);

struct ShapeAxis {
  std::vector<double> nodes;     ///< values at which moments are computed; without interpolation all values
  Eigen::MatrixXd cardinal;      ///< for each value a row of weights, one for each node
  Eigen::MatrixXd coefficients;  ///< converts moments at nodes to Chebyshev coefficients; or empty
  bool is_interpolated() const { return coefficients.size() > 0; }
};

struct ShapePlan {
  ShapeAxis sigma;
  ShapeAxis q;
  MomentsRequest nodes;  ///< the request, but for sigma.nodes and q.nodes, with a smaller tolerance

  std::size_t nodes_of_a_direction() const { return sigma.nodes.size() * q.nodes.size(); }
};

/// The plan for one group of split_grazing_directions(). Empty if every entry is computed separately, for instance if
/// only some entries of a direction and index are wanted.
std::optional<ShapePlan> shape_plan(const MomentsRequest& request);

/// Interpolates the moments of one direction and index to all sigma and q of the request. The error bound sums, over
/// the nodes, |weight| times two errors: the node's error bound and an interpolation error that is estimated from the
/// last Chebyshev coefficients.
void interpolate(const ShapePlan& plan, std::span<const Moments> nodes, std::span<Moments> moments);

}  // namespace dolp
