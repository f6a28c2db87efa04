// Hold-out test of error bounds. Compares new random entries, and climbs from the worst of them, with rules of many
// more digits or with the independent reference.
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
  std::size_t climbs = 0;          ///< number of climbs from the worst entries, each with kClimbSteps steps
  bool against_reference = false;  ///< takes a second of one core per entry
  /// errors are compared with this share of their bounds; below 1 it shows how much the bounds exceed the errors
  double bound_share = 1.0;
};

/// An entry, and its error divided by its stated bound. Above 1 the bound is too small.
struct CheckedEntry {
  MomentsPoint entry;
  double ratio = 0.0;
};

/// Result of the hold-out test of one model.
struct HoldOut {
  std::size_t entries = 0;
  std::size_t understated = 0;  ///< number of entries with a bound that is too small for any moment
  double flagged_share = 0.0;   ///< share of the entries whose bound of rho misses the tolerance at the first level
  double mean_evaluations = 0.0;
  CheckedEntry worst;    ///< drawn
  CheckedEntry climbed;  ///< worst entry found by climbing
};

/// Evaluates the kernel source on the CPU, in float if the tolerance allows it.
/// `model` is a request without entries.
HoldOut hold_out(const MomentsRequest& model, const HoldOutOptions& options);

}  // namespace dolp
