// Growth of the objective around its minima, over two parameters.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "fit/fit.hpp"

namespace dolp::fit {

/// Where the objective, least over all other parameters, has grown to levels, as segments of a line: x and y of the
/// beginning and of the end, values of two parameters.
struct Contours {
  std::array<std::size_t, 2> parameters{};               ///< positions
  std::array<std::vector<Eigen::Vector4d>, 2> segments;  ///< of each level
  std::size_t evaluations = 0;                           ///< parameter sets computed
};
/// The growth whose contours contain 68.27 % and 95 % of all pairs: chi^2 with two degrees of freedom.
inline constexpr std::array kContourLevels = {2.2957, 5.9915};

/// Contours of the two parameters of the largest correlation, within their ranges. None where no correlation is known.
///
/// The objective is computed at the nodes of a grid along the valley's axes. The nodes begin at the minima and the
/// points of the profiles, and spread as far as the growth stays below the higher level. Each begins at the bottom of
/// the valley beside its lowest neighbour; one to which derivatives at another neighbour foretell a lower growth
/// descends from there too. Between nodes the residuals are interpolated, so that valleys narrower than a cell are
/// seen. As long as it costs no more parameter sets than the fit, the grid becomes finer where residuals bend. Errors:
/// those of the evaluator; Cancelled.
std::optional<Contours> contours_of(const Model& model, ModelEvaluator& evaluator, const FitResult& result,
                                    const FitOptions& options);

}  // namespace dolp::fit
