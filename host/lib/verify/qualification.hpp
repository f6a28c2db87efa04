// Compares stored reference moments with the moments of an evaluator, and DOLP with the DOLP that `dolp eval` computes.
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

/// One point with its reference moments, for k_s = 1 without a diffuse part.
struct StoredCase {
  Distribution distribution = Distribution::kCauchy;
  Masking masking = Masking::kIntegral;
  double theta_deg = 0.0;
  SlopeShape shape;
  OpticalConstants index;
  Moments moments;     ///< reference moments, times cos(theta), with bounds of their errors
  std::string name;    ///< name of the case, shared by all distributions and maskings
  std::string origin;  ///< source of the reference moments
};

/// Cases that are hard to compute, for all maskings and both distributions: ends of every range, split points of the
/// integral that coincide, indices that reflect nothing or everything. Accuracy: the errors of the reference r_i and
/// r_q are at most 1.5e-13 r_i, or 3e-11 r_i for the index 1.0001 with its reflectance 3e-9 (test
/// HardCases_References_AreAsGoodAsStated).
std::vector<StoredCase> hard_cases();

/// Reads the text of a file that dolp-reference-values wrote. Lines that begin with # are comments. Errors: InputError.
std::vector<StoredCase> parse_stored_cases(std::string_view text, const std::string& name);

std::vector<StoredCase> read_stored_cases(const std::string& path);

/// The error of one result, measured against a reference, and the bound that the result states.
struct ErrorCheck {
  double error = 0.0;      ///< distance to the reference
  double estimate = 0.0;   ///< bound that the result states; infinite if it states none
  double reference = 0.0;  ///< bound of the reference's own error, in the unit of `error`
  /// (error - reference) / estimate. Above 1 the bound that the result states is wrong.
  double ratio() const;
  bool is_within_estimate() const { return ratio() <= 1.0; }
  /// True if the true error certainly exceeds the tolerance.
  bool is_above(double tolerance) const { return error > tolerance + reference; }
};

struct CaseOutcome {
  StoredCase stored;
  ErrorCheck rho;              ///< largest error of rho_I and rho_Q, relative to rho_I
  ErrorCheck dolp;             ///< absolute error of DOLP
  bool promises_dolp = false;  ///< the status has none of the bits 1, 4 and 8 (see kNoDolpPromised)
  std::uint32_t status = 0;
  /// What is wrong; empty if errors are below the stated bounds, and tolerances are met or status bits 2 or 16 are set.
  std::string complaint;
  double worst_ratio() const;
  bool misses_tolerance() const { return (status & kAnyToleranceNotMet) != 0; }  ///< according to `status`
};

/// A scene for stored cases: the surface only emits, at 300 K and 10.6 um. So DOLP = |rho_Q| / (1 - rho_I).
SceneValues emission_scene(Distribution distribution, Masking masking, double tolerance);

/// Evaluates all cases and compares each with its reference. The result has the order of `cases`. At 90 degrees rho has
/// no finite value with masking none and integral, so DOLP is compared with |r_Q / r_I|. Domain: cases at 90 degrees
/// have one of these two maskings and finite moments. Errors: errors of evaluate_scene.
std::vector<CaseOutcome> qualify(const std::vector<StoredCase>& cases, ModelEvaluator& evaluator,
                                 const Accuracy& accuracy, const Progress& progress);

/// A few ordinary (not hard) cases for each distribution and masking.
std::vector<StoredCase> ordinary_cases();

}  // namespace dolp
