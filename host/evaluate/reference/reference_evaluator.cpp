#include "evaluate/reference/reference_evaluator.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "error.hpp"
#include "evaluate/processor.hpp"
#include "evaluate/reference/hemisphere.hpp"

namespace dolp {

namespace {

void require(bool is_met, const std::string& what, double value) {
  if (!is_met) throw InputError("reference: " + what + ", but it is " + std::to_string(value));
}

// Written so that NaN fails.
void check(const MomentsRequest& request) {
  for (const double theta_deg : request.theta_deg) {
    require(theta_deg >= 0.0 && theta_deg <= 90.0, "theta must be in [0, 90] degrees", theta_deg);
  }
  const bool is_cauchy = request.distribution == Distribution::kCauchy;
  const bool is_smith = request.masking == Masking::kSmith;
  for (const SlopeShape& shape : request.shapes) {
    require(shape.sigma >= 0.0, "sigma must not be negative", shape.sigma);
    require(!is_cauchy || shape.q > 1.0, "q must be above 1", shape.q);
    require(!is_cauchy || !is_smith || shape.q > 1.5, "smith masking needs q above 1.5", shape.q);
  }
  for (const OpticalConstants& index : request.indices) {
    require(index.n > 0.0, "n must be above 0", index.n);
    require(index.k >= 0.0, "k must not be negative", index.k);
  }
}

Moments moments_of(const MomentsRequest& request, const MomentsEntry& entry, const reference::Refinement& refinement) {
  const double theta_deg = request.theta_deg.at(entry.theta);
  const SlopeShape& shape = request.shapes.at(entry.shape);
  const OpticalConstants& constants = request.indices.at(entry.index);
  if (shape.sigma == 0.0) return reference::mirror_moments(theta_deg, constants);
  const reference::Slopes slopes(request.distribution, shape.sigma, shape.q);
  return reference::hemisphere_moments(slopes, request.masking, theta_deg, constants, refinement);
}

// What ReferenceEvaluator promises under "Accuracy".
double relative_tolerance(const ReferenceOptions& options, double requested) {
  if (requested <= 0.0) return options.relative_tolerance;
  return std::min(0.5 * requested, std::max(options.relative_tolerance, 0.01 * requested));
}

// Shares the entries between threads; the calling thread alone talks to `progress`.
class Crew {
 public:
  Crew(const MomentsRequest& request, const reference::Refinement& refinement)
      : request_(request), refinement_(refinement), results_(request.entries.size()) {}

  std::vector<Moments> run(unsigned threads, const Progress& progress) {
    std::vector<std::jthread> workers;
    for (unsigned i = 0; i < threads; ++i) workers.emplace_back([this] { work(); });
    report_until_done(progress, threads);
    workers.clear();
    if (failure_) std::rethrow_exception(failure_);
    return std::move(results_);
  }

 private:
  void work() {
    try {
      for (std::size_t i = next_++; i < results_.size() && !is_stopping_; i = next_++) {
        results_[i] = moments_of(request_, request_.entries[i], refinement_);
        const std::lock_guard lock(mutex_);
        ++done_;
        changed_.notify_one();
      }
    } catch (...) {
      is_stopping_ = true;
      const std::lock_guard lock(mutex_);
      failure_ = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    ++idle_;
    changed_.notify_one();
  }

  void report_until_done(const Progress& progress, unsigned threads) {
    std::unique_lock lock(mutex_);
    for (std::size_t told = 0; idle_ < threads || told < done_;) {
      changed_.wait(lock, [&] { return done_ > told || idle_ == threads; });
      if (done_ == told) continue;
      told = done_;
      lock.unlock();
      try {
        if (progress && !is_stopping_ && !progress(told, results_.size())) throw Cancelled{};
        lock.lock();
      } catch (...) {
        is_stopping_ = true;
        lock.lock();
        failure_ = std::current_exception();
      }
    }
  }

  const MomentsRequest& request_;
  reference::Refinement refinement_;
  std::vector<Moments> results_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> is_stopping_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t done_ = 0;
  unsigned idle_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

std::vector<Moments> ReferenceEvaluator::evaluate(const MomentsRequest& request, const Progress& progress) {
  check(request);
  const auto start = std::chrono::steady_clock::now();
  const reference::Refinement refinement{relative_tolerance(options_, request.tolerance), options_.subdivisions};
  const unsigned available =
      options_.threads > 0 ? options_.threads : std::max(1U, std::thread::hardware_concurrency());
  const auto threads = static_cast<unsigned>(std::min<std::size_t>(available, request.entries.size()));
  std::vector<Moments> results = Crew(request, refinement).run(threads, progress);
  report_.evaluator = "reference";
  report_.device = processor_name();
  report_.precision = "double";
  for (const Moments& moments : results) report_.evaluations += moments.evaluations;
  report_.kernel_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return results;
}

}  // namespace dolp
