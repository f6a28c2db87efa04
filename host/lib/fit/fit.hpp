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

/// The result of a fit. Vectors with one value per measurement are in the order of the data.
struct FitResult : FitNumbers {
  Eigen::MatrixXd correlation;               ///< NaN for parameters at a bound or not determined by the data
  std::optional<double> reduced_chi_square;  ///< empty without degrees of freedom
  /// Change of chi_square by one standard deviation: 1 or, without uncertainties, the mean square of the residuals.
  double scale = 1.0;
  std::size_t determined = 0;          ///< rank of the Jacobian: number of parameters that the data determine
  double numerical_error = 0.0;        ///< largest bound of the model's numerical error, in uncertainties
  double tolerance = 0.0;              ///< tolerance of the model's values
  std::uint32_t status = 0;            ///< status bits of all points together
  Eigen::VectorXd residuals;           ///< (measured - model) / uncertainty; without uncertainties measured - model
  Eigen::VectorXd predicted;           ///< the model's values
  std::size_t evaluations = 0;         ///< parameter sets for which the model was computed
  std::vector<Minimum> valley_points;  ///< the best minimum first, then points of the profiles
  double aic = 0.0;  ///< Akaike's information criterion, up to a constant that only depends on the data
  double bic = 0.0;  ///< Bayes' information criterion, up to a constant that only depends on the data
};

/// "good", "doubtful" or "bad"; empty without a p-value.
std::string fit_quality(const std::optional<double>& p_value);

/// Fits the model to its data: finds the minima, then the intervals around the best one. A doubtful or bad fit gets
/// scaled intervals only if its AIC is at most `most_aic`: a model that is worse than others needs none. Empty if no
/// descent converged. Errors: errors of the evaluator; Cancelled.
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

/// The growth over the two parameters of the largest correlation, within their ranges. Empty if no correlation is
/// known. The objective is computed at the nodes of a regular grid along the principal axes of the covariance. The
/// nodes spread from the minimum and the points of the profiles to beyond the higher level. Each descends from the
/// bottom of the valley beside its lowest neighbour. If this needs more parameter sets than the fit, the grid becomes
/// coarser, or it stays incomplete. Errors: errors of the evaluator; Cancelled.
std::optional<Contours> contours_of(const Model& model, ModelEvaluator& evaluator, const FitResult& result,
                                    const FitOptions& options);

}  // namespace dolp::fit
