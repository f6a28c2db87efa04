// Compares the kernel's doubts and estimates with reference moments: the numbers that RuleModel in plan/rule.hpp is
// calibrated with.
#pragma once

#include <cstddef>
#include <vector>

#include "verify/stored_cases.hpp"

namespace dolp {

/// What one point shows at one tolerance. Errors are distances to the reference less what that may err itself.
struct PointCalibration {
  std::size_t position = 0;     ///< in the list of cases
  double evaluations = 0.0;     ///< integrand evaluations
  double error = 0.0;           ///< max(|d r_i|, |d r_q|) of what the rules sum, over r_i
  double estimate = 0.0;        ///< larger of the stated bounds of r_i and r_q, over r_i
  double factor = 0.0;          ///< what DoubtModel::factor must be multiplied by to bound the error of r_i and r_q
  double deficit_factor = 0.0;  ///< the same for the deficit
  double estimate_to_error =
      0.0;                      ///< estimate over the error of the moments as they are stated; infinite without error
  bool is_understated = false;  ///< one of the four moments is off by more than it states
};

/// The middle and the end of a list of numbers.
struct Spread {
  double median = 0.0;
  double q95 = 0.0;
  double q98 = 0.0;
  double worst = 0.0;
};

/// Quantiles by nearest rank; NaN counts as the largest. Domain: at least one value.
Spread spread_of(std::vector<double> values);

/// All points of one distribution and masking at one tolerance.
struct GroupCalibration {
  Distribution distribution = Distribution::kCauchy;
  Masking masking = Masking::kNone;
  double tolerance = 0.0;
  Spread evaluations;
  Spread error_over_tolerance;
  Spread factor;
  Spread deficit_factor;
  double estimate_to_error = 0.0;        ///< median
  double missed_share = 0.0;             ///< of the points whose estimate is above the tolerance
  std::size_t understated = 0;           ///< points with an estimate below its error
  std::vector<PointCalibration> points;  ///< the worst factor first
};

/// Whether a stored case says something of the rules: a mirror has no integral, and where nothing is reflected errors
/// have no scale.
bool is_calibration_case(const StoredCase& stored);

/// Runs the kernel's text on the CPU for all cases of every distribution and masking that `cases` has.
/// Domain: cases for which is_calibration_case holds.
std::vector<GroupCalibration> calibrate(const std::vector<StoredCase>& cases, double tolerance, bool in_double);

}  // namespace dolp
