#include "studies/timing.hpp"
#include "base/stopwatch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace dolp::bench {
namespace {

struct Timed {
  Solution solution;
  double time_s = 0.0;    ///< time per call
  double kernel_s = 0.0;  ///< time in kernels per call
};

Timed timed(Solver& solver, const MomentsRequest& request, double setting, std::size_t calls) {
  Timed result;
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < calls; ++i) {
    result.solution = solver.solve(request, setting);
    result.kernel_s += result.solution.kernel_s.value_or(0.0);
  }
  const double elapsed_s = seconds_since(start);
  result.time_s = elapsed_s / static_cast<double>(calls);
  result.kernel_s /= static_cast<double>(calls);
  return result;
}

void add(Timed timed, bool is_random, Measurement& measurement) {
  measurement.raw_s.push_back(timed.time_s);
  if (timed.solution.kernel_s) measurement.raw_kernel_s.push_back(timed.kernel_s);
  if (is_random || measurement.answers.empty()) measurement.answers.push_back(timed.solution.answers.front());
  measurement.evaluations = timed.solution.evaluations;
  measurement.last = std::move(timed.solution.answers);
}

}  // namespace

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

double minimum(const std::vector<double>& values) { return *std::ranges::min_element(values); }

double rounded_time(double time_s) { return std::stod(fmt::format("{:.3e}", time_s)); }

std::vector<double> per_entry(std::vector<double> times_s, std::size_t entries) {
  for (double& time_s : times_s) time_s = rounded_time(time_s / static_cast<double>(entries));
  return times_s;
}

double spread(const std::vector<double>& values) { return median(values) / minimum(values) - 1.0; }

Measurement measure(Solver& solver, const MomentsRequest& request, double setting, bool is_random,
                    const TimingPolicy& policy) {
  Measurement measurement;
  const Timed first = timed(solver, request, setting, 1);
  if (!first.solution.own_times_s.empty()) {
    add(first, is_random, measurement);
    measurement.raw_s = first.solution.own_times_s;
    return measurement;
  }
  if (first.time_s >= policy.most_s && !is_random) {
    add(first, is_random, measurement);
    return measurement;
  }
  const auto calls = static_cast<std::size_t>(std::ceil(std::max(1.0, policy.raw_time_s / first.time_s)));
  const std::size_t least = is_random ? policy.random_repeats : policy.min_repeats;
  const std::size_t most = is_random ? policy.random_repeats : policy.max_repeats;
  double total_s = 0.0;
  const auto is_done = [&] {
    const std::size_t repeats = measurement.raw_s.size();
    if (repeats >= most) return true;
    return repeats >= least ? total_s >= policy.enough_s : !is_random && total_s >= policy.most_s;
  };
  while (!is_done()) {
    Timed next = timed(solver, request, setting, calls);
    total_s += next.time_s * static_cast<double>(calls);
    add(std::move(next), is_random, measurement);
  }
  return measurement;
}

}  // namespace dolp::bench
