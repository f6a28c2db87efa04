// Selects which moments of a grid are computed. The others are interpolated.
//
// The moments of one direction and one index are analytic in ln(sigma) and ln(q - 1). So the moments of many slope
// distributions follow from a few Chebyshev nodes, which have a tighter tolerance.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "model/choices.hpp"
#include "model/moments.hpp"

namespace dolp {

/// Groups of directions of a grid that can share one interpolation over slope distributions. Grazing directions form a
/// separate group.
std::vector<std::vector<std::size_t>> split_grazing_directions(const MomentsRequest& request);

/// Values of a parameter, and the nodes from which they are interpolated.
struct ShapeAxis {
  std::vector<double> nodes;     ///< equal to the values if interpolation gains nothing
  Eigen::MatrixXd cardinal;      ///< values x nodes: weights of the moments at the nodes
  Eigen::MatrixXd coefficients;  ///< nodes x nodes: values at the nodes to Chebyshev coefficients; else empty
  bool is_interpolated() const { return coefficients.size() > 0; }
};

/// Plan for a grid. It depends only on the request.
struct ShapePlan {
  ShapeAxis sigma;
  ShapeAxis q;
  MomentsRequest nodes;  ///< the grid of the request's directions and indices, sigma.nodes and q.nodes

  std::size_t nodes_of_a_direction() const { return sigma.nodes.size() * q.nodes.size(); }
};

/// The plan of a request whose directions form one group (split_grazing_directions). Empty if every entry is computed
/// separately, for instance if only some entries of a direction and index are wanted.
std::optional<ShapePlan> shape_plan(const MomentsRequest& request);

/// Interpolates the moments of one direction and index at the request's sigma x q from the moments at the nodes. Bounds
/// are the nodes' bounds, weighted by the interpolant's weights, plus an interpolation error estimated from the last
/// Chebyshev coefficients.
void interpolate(const ShapePlan& plan, std::span<const Moments> nodes, std::span<Moments> moments);

}  // namespace dolp
