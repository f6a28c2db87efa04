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

/// The result of a fit. Vectors with one value per measurement have the order of the data.
struct FitResult : FitNumbers {
  Eigen::MatrixXd correlation;  ///< NaN for parameters at a bound and for parameters that the data do not determine
  std::optional<double> reduced_chi_square;  ///< empty without degrees of freedom
  /// Rise of chi_square one standard deviation from a minimum: 1 with uncertainties, else the mean squared residual.
  double scale = 1.0;
  std::size_t determined = 0;          ///< rank of the Jacobian: number of parameters that the data determine
  double numerical_error = 0.0;        ///< largest ratio of the model's error bound at a point to the uncertainty
  double tolerance = 0.0;              ///< tolerance of the model's values
  std::uint32_t status = 0;            ///< status bits of all points, combined by OR
  Eigen::VectorXd residuals;           ///< (measured - model) / uncertainty; without uncertainties, measured - model
  Eigen::VectorXd predicted;           ///< the model's values
  Eigen::MatrixXd jacobian;            ///< derivatives of `predicted`: a row per measurement, a column per parameter
  std::size_t evaluations = 0;         ///< parameter sets for which the model was computed
  std::vector<Minimum> valley_points;  ///< the best minimum, then the computed points of the profile likelihoods
  double aic = 0.0;                    ///< Akaike's information criterion, without a term that depends only on the data
  double bic = 0.0;                    ///< Bayes' information criterion, without a term that depends only on the data
};

std::string fit_quality(const std::optional<double>& p_value);

/// Finds the minima of the objective and the intervals of the parameters. If the fit is doubtful or bad, also computes
/// the intervals scaled_68 and scaled_95. Omits them if the AIC is above `most_aic`, because then another model is
/// better. Returns nullopt if no descent converged. Errors: errors of the evaluator; Cancelled.
std::optional<FitResult> fit(const Model& model, ModelEvaluator& evaluator, const FitOptions& options,
                             double most_aic = std::numeric_limits<double>::infinity());

/// The objective on a grid over two parameters, minimised over all other parameters.
struct Contours {
  std::array<std::size_t, 2> parameters{};  ///< positions of the two parameters in FitOptions::vary
  std::array<Eigen::MatrixXd, 2> values;    ///< values of the two parameters at each point of the grid
  Eigen::MatrixXd growth;                   ///< (objective - its minimum) / scale; NaN far outside the outer contour
  std::size_t evaluations = 0;              ///< number of parameter sets that were computed
};
/// Levels of `growth` for the contours at 68.27 % and 95 %: quantiles of chi^2 with two degrees of freedom.
inline constexpr std::array kContourLevels = {2.2957, 5.9915};

/// Computes Contours for the two most correlated parameters. Empty if no correlation is known. The grid lies along the
/// principal axes of their covariance, and spreads from the best minimum until it encloses the outer contour. If this
/// costs more than the fit, the grid becomes coarser or stays incomplete. Errors: errors of the evaluator; Cancelled.
std::optional<Contours> compute_contours(const Model& model, ModelEvaluator& evaluator, const FitResult& result,
                                         const FitOptions& options);

}  // namespace dolp::fit
