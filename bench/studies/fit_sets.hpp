// Synthetic data with a known truth for the study of fits.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "fit/descent.hpp"
#include "fit/fit.hpp"
#include "model/evaluator.hpp"

namespace dolp::bench {

/// A synthetic data set: the scene to fit, its varied parameters with their true values, and the kind of measurement.
struct FitSet {
  SceneValues scene;
  std::vector<FitRange> parameters;
  Eigen::VectorXd truth;
  Observable observable = Observable::kQOverI;
  std::size_t points = 0;              ///< number of zeniths, evenly spaced from 2 to 80 degrees
  double uncertainty = 0.0;            ///< standard deviation of the noise in DOLP or Q/I
  bool has_noise = true;               ///< without noise the data are exact
  std::vector<Setting> of_truth = {};  ///< the data come from `scene` with these additional settings
  ModelError model_error = ModelError::kNone;

  /// Keys of the varied parameters, joined by blanks.
  std::string keys() const;
};

/// Makes a random set; `number` is the seed. The set has a random masking and distribution, two to four parameters, 12
/// points, true values inside the search ranges, and noise between 0.0005 and 0.01 (log-uniform).
FitSet fit_set(std::size_t number);

/// Makes a set whose data include all bounces of the light, while the model of the fit has single scattering. The fit
/// varies n and sigma. It compares each Q/I of the data with the bracket, not with one value. The bracket is a range
/// that contains Q/I with all bounces. The data have noise if `number` is odd.
FitSet bracket_set(std::size_t number);

/// The set whose fit is timed: n, k and sigma from 40 points of Q/I.
FitSet timed_set();

/// Computes the data of a set from its true parameters. If the set has noise, adds Gaussian noise with seed `number`.
MeasuredData synthetic_data(const FitSet& set, std::size_t number, ModelEvaluator& evaluator);

/// The result of a fit, compared with the truth.
struct SetOutcome {
  fit::FitResult result;
  double chi_square_of_truth = 0.0;
  double chi_square_from_truth = 0.0;    ///< chi^2 at the minimum that a descent from the true values reaches
  std::size_t held_68 = 0, held_95 = 0;  ///< numbers of 68 % and 95 % intervals that contain the true value
  double time_s = 0.0;

  /// True if every interval contains its true value or is right to exclude it. A 68 % interval is right to exclude it
  /// if chi^2 at the true values exceeds the minimum by more than 1. For a 95 % interval, this limit is 3.84. The
  /// result is meaningful only if FitSet::model_error is kNone.
  bool is_consistent() const;
  /// True unless a descent from the true values lowers the chi^2 of the fit by more than 0.01.
  bool is_global() const;
};

/// Makes the data of a set and fits them. `number` seeds the noise.
SetOutcome fit_outcome(const FitSet& set, std::size_t number, ModelEvaluator& evaluator);

}  // namespace dolp::bench
