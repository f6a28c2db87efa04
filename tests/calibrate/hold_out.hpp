// Hold-out test of error bounds: compares fresh random entries, and a climb from the worst of them, with rules of many
// more digits or the independent reference.
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
  std::size_t climbs = 0;          ///< of the worst entries, each climbed from in kClimbSteps steps
  bool against_reference = false;  ///< a second of a core for each entry
  double bound_share = 1.0;  ///< of each bound that errors are held against: below 1 shows what bounds have to spare
};

/// An entry, and its error over the bound stated with it: above 1 the bound is understated.
struct CheckedEntry {
  MomentsPoint entry;
  double ratio = 0.0;
};

/// The result of the hold-outs of one model.
struct HoldOut {
  std::size_t entries = 0;
  std::size_t understated = 0;  ///< of any of the moments
  double flagged_share = 0.0;   ///< entries whose bound of rho misses the tolerance at the first level
  double mean_evaluations = 0.0;
  CheckedEntry worst;    ///< drawn
  CheckedEntry climbed;  ///< found by climbing
};

/// Evaluates the kernel source on the CPU, in float where the tolerance allows it.
/// `model` is a request without entries.
HoldOut hold_out(const MomentsRequest& model, const HoldOutOptions& options);

}  // namespace dolp
