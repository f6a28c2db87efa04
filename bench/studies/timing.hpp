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
  std::size_t random_repeats = 32;  ///< for methods whose answers differ from call to call
  double enough_s = 0.5;            ///< limit for all repeats together, once there are `min_repeats`
  double most_s = 3.0;              ///< limit for all repeats together, however few; random methods ignore it
  double raw_time_s = 1e-3;         ///< shorter calls are repeated within one raw time
};

/// Raw times of a call, and its results.
struct Measurement {
  std::vector<double> raw_s;          ///< time per call
  std::vector<double> raw_kernel_s;   ///< time of the kernels per call; empty without kernels
  std::vector<Answer> answers;        ///< answers for the first entry: one, or one per repeat of a random method
  std::vector<Answer> last;           ///< answers for all entries, by the last call
  std::optional<double> evaluations;  ///< integrand evaluations per call
};

double median(std::vector<double> values);
double minimum(const std::vector<double>& values);

/// The time with four digits: raw times have no more.
double rounded_time(double time_s);

/// Rounded times per entry, from times of calls with `entries` entries.
std::vector<double> per_entry(std::vector<double> times_s, std::size_t entries);

/// (median - minimum)/minimum: excess of a typical time over an undisturbed one.
double spread(const std::vector<double>& values);

/// Warms up, then times calls of `solver` until the policy is satisfied. If the first call takes `most_s` or longer, it
/// is the only one.
Measurement measure(Solver& solver, const MomentsRequest& request, double setting, bool is_random,
                    const TimingPolicy& policy);

}  // namespace dolp::bench
