// Parameters of a scene from measured data, with intervals and contours.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <dolp/fit.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "fit/descent.hpp"
#include "fit/model.hpp"
#include "model/evaluator.hpp"

namespace dolp::fit {

/// The result of a fit. Lists over observations are in the order of the data.
struct FitResult : FitNumbers {
  Eigen::MatrixXd correlation;               ///< NaN for a parameter at its bound, or that the data do not determine
  std::optional<double> reduced_chi_square;  ///< none without degrees of freedom
  double scale = 1.0;  ///< change of chi_square that is one standard deviation: 1, or the residuals' mean square
  std::size_t determined = 0;          ///< parameters less degeneracies
  double numerical_error = 0.0;        ///< largest bound of the model's error, in uncertainties
  double tolerance = 0.0;              ///< tolerance of the model's values
  std::uint32_t status = 0;            ///< bits of any point
  Eigen::VectorXd residuals;           ///< (measured - model) / uncertainty; without uncertainties measured - model
  Eigen::VectorXd predicted;           ///< the model's values
  std::size_t evaluations = 0;         ///< parameter sets for which the model was computed
  std::vector<Minimum> valley_points;  ///< the best minimum, and points of the profiles
  double aic = 0.0;                    ///< Akaike's information criterion, up to a constant of the data
  double bic = 0.0;                    ///< Bayes' information criterion, up to a constant of the data
};

/// "good", "doubtful" or "bad"; empty without a p-value.
std::string fit_quality(const std::optional<double>& p_value);

/// Fits the model to its data: minima by descents from many starts, then intervals of the best one. The tolerance of
/// the model's values is a hundredth of the least uncertainty; the search uses a wider one. Scaled intervals are given
/// if `aic` is at most `most_aic`, because a model that lies behind others needs none.
/// None when no descent converged. Errors: errors of the evaluator; Cancelled.
std::optional<FitResult> fit(const Model& model, ModelEvaluator& evaluator, const FitOptions& options,
                             double most_aic = std::numeric_limits<double>::infinity());

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
