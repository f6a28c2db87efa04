// Repeated times of one method at one setting.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "methods/method.hpp"

namespace dolp::bench {

/// The number of repeats of a call.
struct TimingPolicy {
  std::size_t min_repeats = 5;
  std::size_t max_repeats = 15;
  std::size_t random_repeats = 32;  ///< of methods whose answers differ from call to call
  double enough_s = 0.5;            ///< of all repeats together, once there are `min_repeats`
  double most_s = 3.0;              ///< of all repeats together, however few they are; random methods ignore it
  double raw_time_s = 1e-3;         ///< shorter calls are made several times for one raw time
};

/// Raw times of a call, and what it gave.
struct Measurement {
  std::vector<double> raw_s;          ///< of one call each
  std::vector<double> raw_kernel_s;   ///< likewise in kernels; empty without kernels
  std::vector<Answer> answers;        ///< of the first entry: one, or one for each repeat of a random method
  std::vector<Answer> last;           ///< of all entries, by the last call
  std::optional<double> evaluations;  ///< of one call
};

double median(std::vector<double> values);
double minimum(const std::vector<double>& values);

/// To four digits: raw times have no more.
double rounded_time(double time_s);

/// The times of one entry each, rounded, from times of calls over `entries`.
std::vector<double> per_entry(std::vector<double> times_s, std::size_t entries);

/// (median - minimum)/minimum: how far a usual time is from an undisturbed one.
double spread(const std::vector<double>& values);

/// Warms up, then times calls of `solver` until the policy is satisfied. A first call that takes all of `most_s` is its
/// own warm-up and the only one.
Measurement measure(Solver& solver, const MomentsRequest& request, double setting, bool is_random,
                    const TimingPolicy& policy);

}  // namespace dolp::bench
