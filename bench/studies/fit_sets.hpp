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

/// A scene, its varied parameters, and their true values.
struct FitSet {
  SceneValues scene;
  std::vector<FitRange> parameters;
  Eigen::VectorXd truth;
  Observable observable = Observable::kQOverI;
  std::size_t points = 0;              ///< zeniths from 2 to 80 degrees
  double uncertainty = 0.0;            ///< standard deviation of the noise in DOLP or Q/I
  bool has_noise = true;               ///< whether the data has noise of that standard deviation
  std::vector<Setting> of_truth = {};  ///< settings of the scene of the data that the fitted scene lacks
  ModelError model_error = ModelError::kNone;

  /// Varied keys joined by blanks.
  std::string keys() const;
};

/// Makes the set with a number, which is the seed of its random choices: one of the maskings and distributions, two to
/// four parameters, 12 points, a truth inside the ranges, and noise of 0.0005 to 0.01, log-uniform.
FitSet fit_set(std::size_t number);

/// Data with all bounces. The fit of n and sigma uses single scattering and its bracket. Sets have noise and no noise
/// in turns.
FitSet bracket_set(std::size_t number);

/// The set whose fit is timed: n, k and sigma from 40 points of Q/I.
FitSet timed_set();

/// The true values, with Gaussian noise if the set has noise. `number` is the seed of the noise.
MeasuredData synthetic_data(const FitSet& set, std::size_t number, ModelEvaluator& evaluator);

/// The result of a fit, compared with the truth.
struct SetOutcome {
  fit::FitResult result;
  double chi_square_of_truth = 0.0;
  double chi_square_from_truth = 0.0;    ///< minimum that a descent from the truth reaches
  std::size_t held_68 = 0, held_95 = 0;  ///< numbers of intervals that contain the truth
  double time_s = 0.0;

  /// Without a model error: true if the intervals contain the truth where the chi^2 of the truth requires it.
  bool is_consistent() const;
  /// True if no descent from the truth reaches a lower objective.
  bool is_global() const;
};

/// Makes the data of a set and fits them. `number` is the seed of the noise.
SetOutcome fit_outcome(const FitSet& set, std::size_t number, ModelEvaluator& evaluator);

}  // namespace dolp::bench
