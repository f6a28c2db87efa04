// Measures the time of one method at one setting, with repeated calls.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "methods/method.hpp"

namespace dolp::bench {

/// Decides how often a call is repeated.
struct TimingPolicy {
  std::size_t min_repeats = 5;
  std::size_t max_repeats = 15;
  std::size_t random_repeats = 32;  ///< repeats of a random method, whose answers differ from call to call
  double enough_s = 0.5;            ///< after min_repeats, no repeat starts once the total time reaches this
  double most_s = 3.0;              ///< no repeat starts once the total time reaches this; random methods ignore it
  double raw_time_s = 1e-3;         ///< a raw time is the mean of several calls if one call is shorter than this
};

/// Raw times of repeated calls in seconds, and their results.
struct Measurement {
  std::vector<double> raw_s;          ///< time per call
  std::vector<double> raw_kernel_s;   ///< time of the kernels per call; empty without kernels
  std::vector<Answer> answers;        ///< answers for the first entry: of every repeat of a random method, else of one
  std::vector<Answer> last;           ///< answers of the last call, for all entries
  std::optional<double> evaluations;  ///< integrand evaluations per call
};

double median(std::vector<double> values);
double minimum(const std::vector<double>& values);

/// The time rounded to four digits, because measured times are not more accurate.
double rounded_time(double time_s);

/// Rounded times per entry. `times_s` are times of calls with `entries` entries.
std::vector<double> per_entry(std::vector<double> times_s, std::size_t entries);

/// (median - minimum)/minimum: by how much a typical time exceeds a time without other load.
double spread(const std::vector<double>& values);

/// Calls `solver` repeatedly. The first call warms up, so its time does not count. `policy` decides how many calls
/// follow. In two cases there is only one call, and its time counts. The first case is a method that measures its times
/// itself. The second case is a method that is not random, if its first call takes policy.most_s or longer.
Measurement measure(Solver& solver, const MomentsRequest& request, double setting, bool is_random,
                    const TimingPolicy& policy);

}  // namespace dolp::bench
