// Stored reference moments: the hard cases that travel with the program, and files of the same form.
#pragma once

#include <string>
#include <string_view>
#include <vector>

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

/// The file host/data/hard_cases.csv as it was when the program was built.
std::string_view embedded_hard_cases_csv();

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

}  // namespace dolp
