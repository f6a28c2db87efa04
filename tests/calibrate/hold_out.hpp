// Tests the error bounds with random entries that were not used to fit the rules. Compares the moments with moments by
// finer rules or by the independent reference. Then searches near the entries with the largest ratio of error to bound
// for a larger ratio. Such a search is called a climb.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "calibrate/random_entries.hpp"

namespace dolp {

struct HoldOutOptions {
  Domain domain = Domain::kOrdinary;
  double tolerance = 1e-4;
  std::size_t entries = 1000;
  std::uint64_t seed = 1;
  std::size_t climbs = 0;          ///< number of climbs; they start from the random entries with the largest ratios
  bool against_reference = false;  ///< compare with the reference, which takes a second per entry on one core
  /// Factor of all error bounds of the rules. The smallest factor at which all bounds still hold shows how far the
  /// bounds are above the errors.
  double bound_share = 1.0;
};

/// An entry, and the ratio of its error to its error bound. If the ratio is above 1, the bound is wrong.
struct CheckedEntry {
  MomentsPoint entry;
  double ratio = 0.0;
};

/// Result of the hold-out test of one model.
struct HoldOut {
  std::size_t entries = 0;
  std::size_t understated = 0;  ///< number of entries where the error of at least one moment exceeds its bound
  /// Share of the entries with an error bound of r_i or r_q above tolerance * r_i. A run would compute them again.
  double flagged_share = 0.0;
  double mean_evaluations = 0.0;
  CheckedEntry worst;    ///< the random entry with the largest ratio
  CheckedEntry climbed;  ///< the entry with the largest ratio, including the entries that climbs found
};

/// Tests the rules of `model`, a request without entries, on the CPU. Computes in double if the tolerance is too small
/// for float.
HoldOut hold_out(const MomentsRequest& model, const HoldOutOptions& options);

}  // namespace dolp
