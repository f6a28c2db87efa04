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

/// The result of a fit. A vector with one value per measurement has the order of the data.
struct FitResult : FitNumbers {
  Eigen::MatrixXd correlation;               ///< NaN for parameters at a bound or not determined by the data
  std::optional<double> reduced_chi_square;  ///< empty without degrees of freedom
  /// Rise of chi_square one standard deviation from a minimum: 1 or, without uncertainties, the mean squared residual.
  double scale = 1.0;
  std::size_t determined = 0;          ///< rank of the Jacobian: number of parameters that the data determine
  double numerical_error = 0.0;        ///< largest bound of the model's numerical errors, divided by the uncertainty
  double tolerance = 0.0;              ///< tolerance of the model's values
  std::uint32_t status = 0;            ///< status bits of all points, combined by OR
  Eigen::VectorXd residuals;           ///< (measured - model) / uncertainty; without uncertainties measured - model
  Eigen::VectorXd predicted;           ///< the model's values
  std::size_t evaluations = 0;         ///< parameter sets for which the model was computed
  std::vector<Minimum> valley_points;  ///< the best minimum, then points of the profile likelihoods
  double aic = 0.0;  ///< Akaike's information criterion, up to a constant that depends only on the data
  double bic = 0.0;  ///< Bayes' information criterion, up to a constant that depends only on the data
};

/// "good", "doubtful" or "bad", from the p-value of a fit; empty without a p-value.
std::string fit_quality(const std::optional<double>& p_value);

/// Fits the model to its data: finds the minima of the objective, then the intervals of the parameters. A doubtful or
/// bad fit gets scaled intervals only if its AIC is at most `most_aic`, because a model that is worse than others needs
/// none. Empty if no descent converged. Errors: errors of the evaluator; Cancelled.
std::optional<FitResult> fit(const Model& model, ModelEvaluator& evaluator, const FitOptions& options,
                             double most_aic = std::numeric_limits<double>::infinity());

/// How much the objective exceeds its minimum, on a grid of two parameters. The other parameters minimise it.
struct Contours {
  std::array<std::size_t, 2> parameters{};  ///< positions of the two parameters in FitOptions::vary
  std::array<Eigen::MatrixXd, 2> values;    ///< values of the two parameters at each point of the grid
  Eigen::MatrixXd growth;                   ///< in squared standard deviations; NaN far outside the higher level
  std::size_t evaluations = 0;              ///< number of parameter sets that were computed
};
/// Levels of the growth whose contours contain 68.27 % and 95 % of all pairs: chi^2 with two degrees of freedom.
inline constexpr std::array kContourLevels = {2.2957, 5.9915};

/// Computes Contours for the two parameters with the largest correlation, within their ranges. Empty if no correlation
/// is known. The nodes form a regular grid along the principal axes of the covariance of both parameters. They spread
/// from the minimum, and from the points of the profiles, until the higher level is enclosed. A descent for each node
/// begins at the bottom of the valley that derivatives predict from its lowest neighbour. If this needs more parameter
/// sets than the fit, the grid becomes coarser or stays incomplete. Errors: errors of the evaluator; Cancelled.
std::optional<Contours> contours_of(const Model& model, ModelEvaluator& evaluator, const FitResult& result,
                                    const FitOptions& options);

}  // namespace dolp::fit
