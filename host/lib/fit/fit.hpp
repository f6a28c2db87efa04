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

/// A local minimum above the best.
struct OtherMinimum {
  Eigen::VectorXd values;
  double chi_square = 0.0;
};

/// The result of a fit. Lists over observations are in the order of the data.
struct FitResult {
  std::vector<FitParameter> parameters;
  Eigen::MatrixXd correlation;               ///< NaN of a parameter at its bound, or that the data do not determine
  double chi_square = 0.0;                   ///< sum of the squares of `residuals`, or of their loss
  std::size_t degrees_of_freedom = 0;        ///< points less parameters; with a model error the points
  std::optional<double> reduced_chi_square;  ///< none without degrees of freedom
  std::optional<double> p_value;             ///< with uncertainties and without a robust loss
  double scale = 1.0;  ///< change of chi_square that is one standard deviation: 1, or the residuals' mean square
  std::vector<OtherMinimum> minima;
  std::vector<std::string> degeneracies;  ///< what the data cannot tell, in words
  std::size_t determined = 0;             ///< parameters less those directions
  double numerical_error = 0.0;           ///< largest bound of the model's error, in uncertainties
  double tolerance = 0.0;                 ///< of the model's values
  std::uint32_t status = 0;               ///< bits of any point
  Eigen::VectorXd residuals;              ///< (measured - model) / uncertainty; without uncertainties measured - model
  Eigen::VectorXd predicted;              ///< the model's values
  std::size_t evaluations = 0;            ///< parameter sets for which the model was computed
  std::vector<Minimum> seen;              ///< the best minimum, and points of the profiles
  double aic = 0.0;                       ///< Akaike's information criterion, up to a constant of the data
  double bic = 0.0;                       ///< Bayes' information criterion, likewise
};

/// "good", "doubtful" or "bad"; empty without a p-value.
std::string fit_quality(const std::optional<double>& p_value);

/// Fits the model to its data: minima by descents from many starts, then intervals of the best one. Its values have a
/// hundredth of the least uncertainty as their tolerance; the search takes a wider one.
/// None when no descent converged. Errors: those of the evaluator; Cancelled.
/// Scaled intervals are there where `aic` is at most `most_aic`: a model that lies behind others needs none.
std::optional<FitResult> fit(const Model& model, ModelEvaluator& evaluator, const FitOptions& options,
                             double most_aic = std::numeric_limits<double>::infinity());

}  // namespace dolp::fit
