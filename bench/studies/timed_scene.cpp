#include "studies/timed_scene.hpp"
#include "base/stopwatch.hpp"

#include <chrono>
#include <cmath>

#include "studies/timing.hpp"

namespace dolp::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kRawTime = 5e-3;  // seconds; a raw time is the mean of several calls if one call is shorter than this
constexpr double kLongTime = 0.5;  // seconds; if the first call takes longer, each raw time covers one call

}  // namespace

TimedScene::TimedScene(SceneValues scene, bool keep_all, ModelEvaluator& evaluator)
    : scene_(std::move(scene)), entries_(grid_entries(scene_)), keep_all_(keep_all), evaluator_(evaluator) {
  const Clock::time_point start = Clock::now();
  work_ = run();
  first_s_ = seconds_since(start);
}

void TimedScene::repeat() {
  if (calls_ == 0) calls_ = calls_of_a_raw_time();
  double kernel_s = 0.0;
  const Clock::time_point start = Clock::now();
  for (std::size_t i = 0; i < calls_; ++i) {
    work_ = run();
    kernel_s += work_.kernel_s + work_.sums_s;
  }
  const auto calls = static_cast<double>(calls_);
  raw_s_.push_back(seconds_since(start) / calls);
  raw_kernel_s_.push_back(kernel_s / calls);
}

std::vector<double> TimedScene::times_s() const { return per_entry(raw_s_, entries_.size()); }

std::vector<double> TimedScene::kernel_times_s() const { return per_entry(raw_kernel_s_, entries_.size()); }

std::size_t TimedScene::calls_of_a_raw_time() {
  if (first_s_ > kLongTime) return 1;
  const Clock::time_point start = Clock::now();
  run();
  return static_cast<std::size_t>(std::ceil(std::max(1.0, kRawTime / seconds_since(start))));
}

Work TimedScene::run() {
  evaluator_.clear_report();
  plan_ = plan_effects(scene_, entries_, keep_all_);
  CollectedResults results(entries_);
  const Work work = run_scene(scene_, entries_, plan_, &evaluator_, {results.sink()}).work;
  results_ = results.take();
  return work;
}

}  // namespace dolp::bench
