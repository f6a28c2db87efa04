// Compares an evaluator with stored reference moments, through the radiometry, as `dolp eval` computes them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <dolp/status.hpp>
#include "model/evaluator.hpp"
#include "scene/scene.hpp"
#include "verify/stored_cases.hpp"

namespace dolp {

/// The error of one result beside what the result states about it.
struct ErrorCheck {
  double error = 0.0;      ///< distance to the reference
  double estimate = 0.0;   ///< the stated bound; infinite where nothing is stated
  double reference = 0.0;  ///< bound of the reference's own error, in the same units
  /// error / estimate, less what the reference may err itself: above 1 the estimate is wrong.
  double ratio() const;
  bool is_within_estimate() const { return ratio() <= 1.0; }
  /// True where the error certainly exceeds a tolerance.
  bool is_above(double tolerance) const { return error > tolerance + reference; }
};

/// The result of one case.
struct CaseOutcome {
  std::size_t position = 0;    ///< in the list of cases
  ErrorCheck rho;              ///< max(|d rho_I|, |d rho_Q|) / rho_I
  ErrorCheck dolp;             ///< |d DOLP|
  bool promises_dolp = false;  ///< whether the tolerance is promised for DOLP: status has none of the bits 1, 4, 8
  std::uint32_t status = 0;
  std::string complaint;  ///< empty when the case is right: errors below estimates, tolerances met or status 2 or 16
  double worst_ratio() const;
};

/// The scene that cases of one distribution and masking are looked at in: a surface that only emits, at 300 K and
/// 10.6 um, so that DOLP = |rho_Q| / (1 - rho_I).
SceneValues emission_scene(Distribution distribution, Masking masking, double tolerance);

/// Evaluates all cases and compares each with its reference, in the order of `cases`.
///
/// At 90 degrees rho has no finite value under masking none and `integral`; DOLP is compared with |r_Q / r_I| there.
/// Domain: cases at 90 degrees are of those two maskings and have finite moments.
/// Errors: those of evaluate_scene.
std::vector<CaseOutcome> qualify(const std::vector<StoredCase>& cases, ModelEvaluator& evaluator,
                                 const Accuracy& accuracy, const Progress& progress);

/// Accuracy of an evaluator on a few ordinary cases of every distribution and masking.
struct DeviceQuality {
  std::size_t cases = 0;
  std::size_t missed = 0;    ///< of them, those that say they miss the tolerance
  double tolerance = 0.0;    ///< what was asked for
  double worst_error = 0.0;  ///< max(|d rho_I|, |d rho_Q|) / rho_I
  std::string worst_case;    ///< "cauchy integral sigma-1e-2"
  bool is_sound = true;      ///< no error above its estimate, no tolerance missed silently
};

/// Measures an evaluator, for a list of devices; `dolp verify --hard-cases` is the thorough examination.
/// Errors: those of evaluate_scene.
DeviceQuality measure_quality(ModelEvaluator& evaluator, const Accuracy& accuracy);

}  // namespace dolp
