// Parameters of a scene from measured data, with intervals.
#pragma once

#include <Eigen/Core>
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

}  // namespace dolp::fit
