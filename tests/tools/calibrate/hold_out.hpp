// Tests the error bounds that quadrature rules state for moments (reflectances times cos(theta)). The test uses random
// entries that are not in the fit of the rules. An entry is a zenith angle, a roughness and a refractive index. A finer
// rule or the independent reference computes each moment again. The difference is the error of the moment. Then the
// test searches near the entries with the largest ratio of error to bound for entries with an even larger ratio. Such a
// random search is called a climb.
#pragma once

#include <cstddef>
#include <cstdint>

#include "calibrate/random_entries.hpp"

namespace dolp {

struct HoldOutOptions {
  Domain domain = Domain::kOrdinary;
  double tolerance = 1e-4;
  std::size_t entries = 1000;
  std::uint64_t seed = 1;
  std::size_t climbs = 0;          ///< number of climbs, each from one of the entries with the largest ratios
  bool against_reference = false;  ///< compare with the reference, which takes a second per entry on one core
  /// The test multiplies all error bounds of the rules by this number. If the bounds hold even with a small number,
  /// they are far above the errors.
  double bound_share = 1.0;
};

/// An entry, and the ratio of its error to its error bound. If the ratio is above 1, the bound is wrong.
struct CheckedEntry {
  MomentsPoint entry;
  double ratio = 0.0;
};

/// Result of hold_out().
struct HoldOut {
  std::size_t entries = 0;
  std::size_t understated = 0;  ///< number of entries where the error of at least one moment exceeds its bound
  /// Share of the entries with an error bound of r_i or r_q above tolerance * r_i. A run would compute them again.
  double flagged_share = 0.0;
  double mean_evaluations = 0.0;
  CheckedEntry worst;    ///< the random entry with the largest ratio
  CheckedEntry climbed;  ///< the entry with the largest ratio among the random entries and those that climbs found
};

/// Tests rules on the CPU. `model` is a request without entries. Its masking, scattering and distribution select the
/// rules. Computes in double if the tolerance is too small for float.
HoldOut hold_out(const MomentsRequest& model, const HoldOutOptions& options);

}  // namespace dolp
