// Test of the error bounds with random entries that did not take part in the fit of the rules. Compares the results
// with those of finer rules or of the independent reference. A climb then searches near a bad entry for a worse one.
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
  std::size_t climbs = 0;          ///< a climb starts from each of so many entries, the worst of the random ones
  bool against_reference = false;  ///< compare with the reference, which takes a second of one core per entry
  /// multiplies all bounds. The smallest share without an error above its bound shows how much too large bounds are.
  double bound_share = 1.0;
};

/// An entry, and its error divided by its stated bound. Above 1 the bound is wrong.
struct CheckedEntry {
  MomentsPoint entry;
  double ratio = 0.0;
};

/// Result of the hold-out test of one model.
struct HoldOut {
  std::size_t entries = 0;
  std::size_t understated = 0;  ///< number of entries where the error of at least one moment exceeds its bound
  /// share of the entries whose bound of r_i or r_q exceeds the tolerance, so that a run would compute them again
  double flagged_share = 0.0;
  double mean_evaluations = 0.0;
  CheckedEntry worst;    ///< worst of the random entries
  CheckedEntry climbed;  ///< worst of all entries, including those that climbs found
};

/// Tests the rules of one model on the CPU, in float if the tolerance allows it. `model` is a request without entries.
HoldOut hold_out(const MomentsRequest& model, const HoldOutOptions& options);

}  // namespace dolp
