// Compares moments from an evaluator, and the DOLP that follows from them, with stored reference values.
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

/// A point with its reference moments. The surface has specular weight k_s = 1 and no diffuse part.
struct StoredCase {
  Distribution distribution = Distribution::kCauchy;
  Masking masking = Masking::kIntegral;
  double theta_deg = 0.0;
  SlopeShape shape;
  OpticalConstants index;
  Moments moments;     ///< reference values and bounds of their errors; r_i is rho_I cos(theta)
  std::string name;    ///< cases that differ only in distribution and masking have the same name
  std::string origin;  ///< how the reference moments were computed
};

/// Cases that are hard to compute, for all maskings and distributions. Examples: ends of ranges, and indices that
/// reflect nothing or everything. Accuracy: the errors of the reference r_i and r_q are at most 1.5e-13 r_i. For the
/// index 1.0001 they are at most 3e-11 r_i (test HardCases_References_AreAsGoodAsStated).
std::vector<StoredCase> hard_cases();

/// Reads the text of a file that dolp-reference-values wrote. Lines that begin with # are comments. Errors: InputError.
std::vector<StoredCase> parse_stored_cases(std::string_view text, const std::string& name);

std::vector<StoredCase> read_stored_cases(const std::string& path);

struct ErrorCheck {
  double error = 0.0;      ///< distance between the result and its reference
  double estimate = 0.0;   ///< error bound that the result states; infinite if it states none
  double reference = 0.0;  ///< bound of the error of the reference, in the unit of `error`
  /// (error - reference) / estimate, or min(1, error / estimate) if error <= reference: the result may then be exact.
  double ratio() const;
};

struct CaseOutcome {
  StoredCase stored;
  ErrorCheck rho;   ///< largest error of rho_I and rho_Q, relative to rho_I
  ErrorCheck dolp;  ///< absolute error of DOLP
  std::uint32_t status = 0;
  /// The fault: an error above its bound, or a missed tolerance without its status bit. Empty if nothing.
  std::string complaint;
  double worst_ratio() const;
  bool misses_tolerance() const { return (status & kAnyToleranceNotMet) != 0; }
};

/// A scene for stored cases: the surface only emits, at 300 K and 10.6 um. So DOLP = |rho_Q| / (1 - rho_I).
SceneValues emission_scene(Distribution distribution, Masking masking, double tolerance);

/// Evaluates all cases and compares each with its reference, in the order of `cases`. At 90 degrees rho is infinite,
/// but the moments r_i and r_q are finite. So there the function compares only DOLP, with |r_q / r_i|. Domain: a case
/// at 90 degrees has masking `none` or `integral`, and finite reference moments. Errors: errors of evaluate_scene.
std::vector<CaseOutcome> qualify(const std::vector<StoredCase>& cases, ModelEvaluator& evaluator,
                                 const Accuracy& accuracy, const Progress& progress);

std::vector<StoredCase> ordinary_cases();

}  // namespace dolp
