#include "studies/peer_settings.hpp"
#include "base/stopwatch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

#include "studies/timing.hpp"

namespace dolp::bench {
namespace {

constexpr double kShortCall = 0.01;  // seconds; a shorter call runs twice, and the smaller time counts

/// A request for only entry `i` of the sample.
MomentsRequest one_of(const PeerSample& sample, std::size_t i) {
  MomentsRequest request;
  request.distribution = sample.alone.distribution;
  request.masking = sample.alone.masking;
  request.tolerance = sample.alone.tolerance;
  request.precision = sample.alone.precision;
  request.append(sample.alone[i]);
  return request;
}

/// A call of a solver, with its time.
struct Call {
  Solution solution;
  double time_s = 0.0;
};

Call call(Solver& solver, const MomentsRequest& request, double setting) {
  const auto start = std::chrono::steady_clock::now();
  Call made{solver.solve(request, setting)};
  const double elapsed_s = seconds_since(start);
  const std::vector<double>& own_s = made.solution.own_times_s;
  made.time_s = own_s.empty() ? elapsed_s : median(own_s);
  return made;
}

Call undisturbed_call(Solver& solver, const MomentsRequest& request, double setting) {
  Call first = call(solver, request, setting);
  if (first.time_s > kShortCall || !first.solution.own_times_s.empty()) return first;
  Call second = call(solver, request, setting);
  return second.time_s < first.time_s ? second : first;
}

/// Stride of the grid on which a batched method tries its settings. A method that interpolates gets the full grid,
/// because such a method is fast only on a dense grid.
std::size_t stride_of_tries(const Method& method) { return method.needs_grid ? 1 : NestedGrid::kLargestStride; }

}  // namespace

PeerSample::PeerSample(Masking which, const std::vector<NestedGrid::Place>& sample_places)
    : masking(which), places(sample_places), alone(sample_request(which, sample_places)), truths(truths_of(alone)) {}

double PeerBatch::worst_error(const std::vector<Answer>& answers, const PeerSample& sample) const {
  double worst = 0.0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double error = error_of(answers[positions[i]], sample.truths[i]);
    worst = std::isnan(error) ? std::numeric_limits<double>::infinity() : std::max(worst, error);
  }
  return worst;
}

PeerBatch whole_sample(const PeerSample& sample) {
  PeerBatch batch{sample.alone, std::vector<std::size_t>(sample.places.size())};
  std::iota(batch.positions.begin(), batch.positions.end(), 0U);
  return batch;
}

PeerBatch nested_grid(const PeerSample& sample, std::size_t stride) {
  PeerBatch batch{steel_request(sample.masking, NestedGrid::with_stride(stride)), {}};
  for (const NestedGrid::Place& place : sample.places) batch.positions.push_back(place.position(stride));
  return batch;
}

double TriedSetting::worst_error() const { return *std::ranges::max_element(errors); }

PeerSettings::PeerSettings(const Method& method, Solver& solver, const PeerSample& sample, double most_s)
    : method_(method), solver_(solver), sample_(sample), most_s_(most_s) {
  warm_up();
}

const TriedSetting* PeerSettings::reaching(double tolerance) {
  for (const TriedSetting& tried : tried_) {
    if (tried.worst_error() <= tolerance) return &tried;
  }
  while (tried_.size() < method_.settings.size() && !is_over_) {
    if (try_next() && tried_.back().worst_error() <= tolerance) return &tried_.back();
  }
  return nullptr;
}

void PeerSettings::reject(const TriedSetting& setting, double error) {
  for (TriedSetting& tried : tried_) {
    if (tried.setting == setting.setting) tried.errors.front() = std::max(tried.errors.front(), error);
  }
  why_not_ = fmt::format("at {:g}, the finest setting tried, its error is {:.1e}", setting.setting, error);
}

std::optional<double> PeerSettings::with_hindsight(double tolerance) const {
  double sum_s = 0.0;
  for (std::size_t i = 0; i < sample_.truths.size(); ++i) {
    double cheapest_s = std::numeric_limits<double>::infinity();
    for (const TriedSetting& tried : tried_) {
      if (tried.errors[i] <= tolerance) cheapest_s = std::min(cheapest_s, tried.times_s[i]);
    }
    sum_s += cheapest_s;
  }
  if (std::isinf(sum_s)) return std::nullopt;
  return sum_s / static_cast<double>(sample_.truths.size());
}

/// Runs the method once without timing, so that the times exclude the compilation of kernels and tables of nodes.
void PeerSettings::warm_up() {
  const MomentsRequest request =
      method_.is_batched ? nested_grid(sample_, stride_of_tries(method_)).request : one_of(sample_, 0);
  try {
    solver_.solve(request, method_.settings.front());
  } catch (const Unavailable&) {
    // The first timed call fails in the same way and reports the error.
  }
}

bool PeerSettings::try_next() {
  TriedSetting tried{.setting = method_.settings[tried_.size()]};
  double total_s = 0.0;
  try {
    total_s = method_.is_batched ? try_grid(tried) : try_each(tried);
  } catch (const Unavailable& error) {
    is_over_ = true;
    why_not_ = fmt::format("at {:g} {}", tried.setting, error.what());
    return false;
  }
  tried_.push_back(std::move(tried));
  const TriedSetting& last = tried_.back();
  if (total_s > most_s_) {
    is_over_ = true;
    why_not_ = fmt::format("at {:g} its error is still {:.1e}; more takes too long", last.setting, last.worst_error());
  } else if (tried_.size() == method_.settings.size()) {
    why_not_ = fmt::format("at {:g}, its finest setting, its error is {:.1e}", last.setting, last.worst_error());
  }
  return true;
}

/// Tries a setting on a whole grid. Returns the time of the call in seconds.
double PeerSettings::try_grid(TriedSetting& tried) {
  const PeerBatch batch = nested_grid(sample_, stride_of_tries(method_));
  const Call made = call(solver_, batch.request, tried.setting);
  for (std::size_t i = 0; i < batch.positions.size(); ++i) {
    tried.errors.push_back(error_of(made.solution.answers[batch.positions[i]], sample_.truths[i]));
    tried.times_s.push_back(made.time_s / static_cast<double>(batch.request.size()));
  }
  return made.time_s;
}

double PeerSettings::try_each(TriedSetting& tried) {
  double total_s = 0.0;
  for (std::size_t i = 0; i < sample_.truths.size(); ++i) {
    const Call made = undisturbed_call(solver_, one_of(sample_, i), tried.setting);
    tried.errors.push_back(error_of(made.solution.answers.front(), sample_.truths[i]));
    tried.times_s.push_back(made.time_s);
    total_s += made.time_s;
  }
  return total_s;
}

}  // namespace dolp::bench
