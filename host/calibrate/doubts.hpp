// Random entries, how large their errors are beside the kernel's doubts, and the features that DoubtModel explains that
// with: what host/calibrate/fit_doubts.py fits.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "plan/doubt_model.hpp"
#include "verify/stored_cases.hpp"

namespace dolp {

/// One entry at one number of digits.
struct DoubtSample {
  double digits = 0.0;  ///< of the rule
  /// log10 of the error beyond cut, rounding and tables, over the doubt: for r_i and r_q, and for the deficit;
  /// -infinity where there is none, NaN where there is no doubt.
  double excess[2] = {};
  DoubtFeatures features[2] = {};
};

/// `count` entries at each of some numbers of digits, half as many where that takes long. Errors are against rules of
/// four digits more, at most those of tolerance 1e-15. Deterministic.
std::vector<DoubtSample> doubt_samples(Distribution distribution, Masking masking, std::size_t count,
                                       std::uint64_t seed);

/// The stored cases of one model at tolerances from 1e-2 to 1e-15, against their own references.
std::vector<DoubtSample> doubt_samples(Distribution distribution, Masking masking,
                                       const std::vector<StoredCase>& cases);

}  // namespace dolp
