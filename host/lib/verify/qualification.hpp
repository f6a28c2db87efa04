// Stored reference moments, and how an evaluator compares with them, through the radiometry, as `dolp eval` computes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <dolp/status.hpp>
#include "model/evaluator.hpp"
#include "model/moments.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// One point with its reference moments, k_s = 1, no diffuse part.
struct StoredCase {
  Distribution distribution = Distribution::kCauchy;
  Masking masking = Masking::kIntegral;
  double theta_deg = 0.0;
  SlopeShape shape;
  OpticalConstants index;
  Moments moments;     ///< times cos(theta), with bounds of the reference's own errors
  std::string name;    ///< name of the case; each distribution and masking has a case of that name
  std::string origin;  ///< where the values come from
};

/// The model's hard cases: ends of every range, coinciding split lines, indices that reflect nothing or everything; all
/// maskings, both distributions.
/// Accuracy: |d r_i| and |d r_q| at most 1.5e-13 r_i, for N = 1.0001, which reflects 3e-9, 3e-11 r_i
///   (test HardCases_References_AreAsGoodAsStated).
std::vector<StoredCase> hard_cases();

/// Cases from the text of a file that dolp-reference-values wrote; lines that begin with # are left out.
/// Errors: InputError that names file, line and column.
std::vector<StoredCase> parse_stored_cases(std::string_view text, const std::string& name);

/// Cases from a file of that form. Errors: InputError.
std::vector<StoredCase> read_stored_cases(const std::string& path);

/// The error of one result, and the bound that the result states.
struct ErrorCheck {
  double error = 0.0;      ///< distance to the reference
  double estimate = 0.0;   ///< the stated bound; infinite where nothing is stated
  double reference = 0.0;  ///< bound of the reference's own error, in the same units
  /// error / estimate, after subtracting the reference's own error: above 1 the estimate is wrong.
  double ratio() const;
  bool is_within_estimate() const { return ratio() <= 1.0; }
  /// True where the error certainly exceeds a tolerance.
  bool is_above(double tolerance) const { return error > tolerance + reference; }
};

/// The result of one case.
struct CaseOutcome {
  StoredCase stored;
  ErrorCheck rho;              ///< max(|d rho_I|, |d rho_Q|) / rho_I
  ErrorCheck dolp;             ///< |d DOLP|
  bool promises_dolp = false;  ///< the tolerance is promised for DOLP: status has no bit 1, 4 or 8
  std::uint32_t status = 0;
  std::string complaint;  ///< empty when the case is right: errors below estimates, tolerances met or status 2 or 16
  double worst_ratio() const;
  bool misses_tolerance() const { return (status & kAnyToleranceNotMet) != 0; }  ///< and states it
};

/// The scene of the cases of one distribution and masking: a surface that only emits, at 300 K and 10.6 um, so that
/// DOLP = |rho_Q| / (1 - rho_I).
SceneValues emission_scene(Distribution distribution, Masking masking, double tolerance);

/// Evaluates all cases and compares each with its reference, in the order of `cases`.
///
/// At 90 degrees, rho has no finite value with masking none and integral; DOLP is compared with |r_Q / r_I|.
/// Domain: cases at 90 degrees have one of these maskings and finite moments.
/// Errors: errors of evaluate_scene.
std::vector<CaseOutcome> qualify(const std::vector<StoredCase>& cases, ModelEvaluator& evaluator,
                                 const Accuracy& accuracy, const Progress& progress);

/// A few ordinary cases for each distribution and masking.
std::vector<StoredCase> ordinary_cases();

}  // namespace dolp
