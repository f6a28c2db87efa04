// Growth of the objective around a minimum, over two parameters.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "fit/fit.hpp"

namespace dolp::fit {

/// Growth of the objective over two parameters, least over all others. Each value of the first has a row of values of
/// the second around the bottom of the valley there, so that narrow and bent ones are seen.
struct Contours {
  std::array<std::size_t, 2> parameters{};  ///< positions
  std::vector<double> first;                ///< values, one for each row
  Eigen::MatrixXd second;                   ///< values, ascending along each row
  Eigen::MatrixXd growth;                   ///< over the scale; NaN where the model has no value
};
/// The growth whose contours contain 68.27 % and 95 % of all pairs: chi^2 with two degrees of freedom.
inline constexpr std::array kContourLevels = {2.2957, 5.9915};

/// Contours of the two parameters of the largest correlation, around the best minimum, wider than their 95 % intervals,
/// within their ranges. None where no correlation is known. Errors: those of the evaluator; Cancelled.
std::optional<Contours> contours_of(const Model& model, MomentsEvaluator& evaluator, const FitResult& result,
                                    const FitOptions& options);

}  // namespace dolp::fit
