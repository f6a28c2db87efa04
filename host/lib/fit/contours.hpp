// The growth of the objective around its minimum, over two parameters.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

#include "fit/fit.hpp"

namespace dolp::fit {

/// The growth of the objective, least over all other parameters, on a grid of two parameters.
struct Contours {
  std::array<std::size_t, 2> parameters{};  ///< positions of both parameters
  std::array<Eigen::MatrixXd, 2> values;    ///< values of both parameters at each point of the grid
  Eigen::MatrixXd growth;                   ///< in standard deviations squared; NaN outside of the higher level
  std::size_t evaluations = 0;              ///< parameter sets computed
};
/// The growth whose contours contain 68.27 % and 95 % of all pairs: chi^2 with two degrees of freedom.
inline constexpr std::array kContourLevels = {2.2957, 5.9915};

/// The growth over the two parameters of the largest correlation, within their ranges. None where no correlation is
/// known.
///
/// The objective is computed at the nodes of a regular grid along the principal axes of the covariance. The nodes begin
/// at the minimum and the points of the profiles, and spread to beyond the higher level. Each descends
/// from the bottom of the valley beside its lowest neighbour. A valley that takes more parameter sets than the fit gets
/// a coarser grid, or ends. Errors: errors of the evaluator; Cancelled.
std::optional<Contours> contours_of(const Model& model, ModelEvaluator& evaluator, const FitResult& result,
                                    const FitOptions& options);

}  // namespace dolp::fit
