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

/// Groups of directions that can share one interpolation over slope distributions. If the masking is none or integral,
/// grazing directions are a group of their own, because their moments depend on the mean slope.
std::vector<std::vector<std::size_t>> split_grazing_directions(const MomentsRequest& request);

struct ShapeAxis {
  std::vector<double> nodes;     ///< values at which moments are computed; without interpolation all values
  Eigen::MatrixXd cardinal;      ///< for each value a row of weights, one for each node
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

/// Interpolates the moments of one direction and index to all sigma and q of the request. The error bound is the
/// sum of |weight| * (error bound + estimated interpolation error) over the nodes.
void interpolate(const ShapePlan& plan, std::span<const Moments> nodes, std::span<Moments> moments);

}  // namespace dolp
