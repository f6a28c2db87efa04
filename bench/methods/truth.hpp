// Values from the independent reference, to find the error of each method.
#pragma once

#include <vector>

#include "methods/method.hpp"
#include "model/moments.hpp"

namespace dolp::bench {

/// The reference's moments of one entry.
struct Truth {
  Moments moments;
  double bound = 0.0;   ///< bound of max(|d r_i|, |d r_q|)/r_i, where d r_i and d r_q are the errors of r_i and r_q
  double time_s = 0.0;  ///< time per entry, on one core
};

/// Moments from the reference at its tightest setting, for every entry of a request.
std::vector<Truth> truths_of(MomentsRequest request);

/// max(|d r_i|, |d r_q|)/r_i, where d r_i and d r_q are the differences between answer and truth.
double error_of(const Answer& answer, const Truth& truth);

}  // namespace dolp::bench
