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
  std::vector<double> nodes;     ///< equal to the values if interpolation gains nothing
  Eigen::MatrixXd cardinal;      ///< values x nodes: weights of the moments at the nodes
  Eigen::MatrixXd coefficients;  ///< nodes x nodes: node values to Chebyshev coefficients; or empty
  bool is_interpolated() const { return coefficients.size() > 0; }
};

struct ShapePlan {
  ShapeAxis sigma;
  ShapeAxis q;
  MomentsRequest nodes;  ///< the grid of the request's directions and indices, sigma.nodes and q.nodes

  std::size_t nodes_of_a_direction() const { return sigma.nodes.size() * q.nodes.size(); }
};

/// The plan for one group of split_grazing_directions(). Empty if every entry is computed separately, for instance if
/// only some entries of a direction and index are wanted.
std::optional<ShapePlan> shape_plan(const MomentsRequest& request);

/// Interpolates the moments of one direction and index at the request's sigma x q. An error bound is the sum of the
/// nodes' bounds times |weight|, plus an interpolation error estimated from the last Chebyshev coefficients.
void interpolate(const ShapePlan& plan, std::span<const Moments> nodes, std::span<Moments> moments);

}  // namespace dolp
