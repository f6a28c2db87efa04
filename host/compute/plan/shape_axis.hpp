// One parameter of the slope distributions of a request, and the fewer values from which the others are interpolated.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "model/choices.hpp"
#include "model/moments.hpp"

namespace dolp {

/// The moments are analytic in ln(x - origin) within `strip` of the real axis, x being sigma or q.
///
/// For sigma: with the slope in units of m, sigma enters P(u) = (1 + u^2)^-q alone, analytic where |Im ln m| < pi/2;
/// toward there a power of q grows, so that a smaller strip is used. For q: P is analytic for Re q > 1; the mean
/// slope, on which smith masking depends and, without shadows that bound it, the projection of the facets at grazing
/// incidence, for Re q > 3/2 (shaders/physics/README.md, section 2). A polynomial of n nodes in the logarithm then is
/// wrong by rho^-n, rho = exp(asinh(strip / half length)).
struct ShapeParameter {
  double origin = 0.0;
  double strip = 1.0;
};
ShapeParameter sigma_parameter(Distribution distribution);
/// All of the request's directions are grazing, or none is.
ShapeParameter q_parameter(const MomentsRequest& request);
/// Positions of the directions of a grid, in groups that have one parameter each: all of them, or the grazing ones
/// apart.
std::vector<std::vector<std::size_t>> split_grazing_directions(const MomentsRequest& request);

/// Values of a parameter, and the nodes from which they are interpolated.
struct ShapeAxis {
  std::vector<double> nodes;     ///< the values themselves where interpolation gains nothing
  Eigen::MatrixXd cardinal;      ///< values x nodes: weights of the moments at the nodes
  Eigen::MatrixXd coefficients;  ///< nodes x nodes: from values to Chebyshev coefficients; empty without interpolation
  bool is_interpolated() const { return coefficients.size() > 0; }
};

/// Nodes for `values`, all different, such that the interpolation keeps `digits` decimal digits.
ShapeAxis shape_axis(const ShapeParameter& parameter, const std::vector<double>& values, double digits);

}  // namespace dolp
