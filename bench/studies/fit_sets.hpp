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
  double uncertainty = 0.0;            ///< standard deviation of DOLP or Q/I
  bool has_noise = true;               ///< of that deviation
  std::vector<Setting> of_truth = {};  ///< that the scene of the data has and the fitted one has not
  ModelError model_error = ModelError::kNone;

  /// Varied keys joined by blanks.
  std::string keys() const;
};

/// The set of a number, which is the seed of all that is random: one of the maskings and distributions, two to four
/// parameters, 12 points, the truth inside of the ranges, noise of 0.0005 to 0.01, log-uniform.
FitSet fit_set(std::size_t number);

/// Data of all bounces, with and without noise in turn, for the fit of n and sigma with single scattering and its
/// bracket.
FitSet bracket_set(std::size_t number);

/// n, k and sigma of 40 points of Q/I, of which the time of a fit is taken.
FitSet timed_set();

/// The truth, with Gaussian noise where the set has it. `number`: the seed of the noise.
MeasuredData synthetic_data(const FitSet& set, std::size_t number, ModelEvaluator& evaluator);

/// A fit of a set against its truth.
struct SetOutcome {
  fit::FitResult result;
  double chi_square_of_truth = 0.0;
  double chi_square_from_truth = 0.0;    ///< of the minimum that a descent from the truth ends in
  std::size_t held_68 = 0, held_95 = 0;  ///< intervals that hold the truth
  double time_s = 0.0;

  /// Without a model error: true where the intervals contain the truth wherever the truth's own chi^2 requires it.
  bool is_consistent() const;
  /// True where no descent from the truth reaches a lower objective.
  bool is_global() const;
};

/// Makes the data of a set and fits them. `number`: the seed of the noise.
SetOutcome fit_outcome(const FitSet& set, std::size_t number, ModelEvaluator& evaluator);

}  // namespace dolp::bench
