#include "evaluate/run/prediction.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "evaluate/run/moments_block.hpp"
#include "evaluate/run/scene_run.hpp"

namespace dolp {
namespace {

// Its multiples modulo 1 fill the interval evenly and keep no step with the axes of a grid.
constexpr double kGoldenRatio = 0.6180339887498949;

std::vector<SceneEntry> drawn_entries(std::span<const SceneEntry> entries) {
  if (entries.size() <= kCountedEntries) return {entries.begin(), entries.end()};
  std::set<std::size_t> positions;
  for (std::size_t i = 0; i < kCountedEntries; ++i) {
    const double part = std::fmod(static_cast<double>(i) * kGoldenRatio, 1.0);
    positions.insert(static_cast<std::size_t>(part * static_cast<double>(entries.size())));
  }
  std::vector<SceneEntry> drawn;
  for (const std::size_t position : positions) drawn.push_back(entries[position]);
  return drawn;
}

/// Notes what the attempts of a run ask for.
class CountingEvaluator final : public MomentsEvaluator {
 public:
  CountingEvaluator(Precision precision, bool has_double) : cpu_(precision), has_double_(has_double) {}

  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override {
    const double before = cpu_.report().evaluations;
    std::vector<Moments> moments = cpu_.evaluate(request, progress);
    const double spent = cpu_.report().evaluations - before;
    const bool is_first = first_moments_ == 0;
    (is_first ? first_moments_ : again_moments_) += request.entries.size();
    (is_first ? first_evaluations_ : again_evaluations_) += spent;
    return moments;
  }
  Precision precision() const override { return cpu_.precision(); }
  bool has_double() const override { return has_double_; }
  EvaluationReport report() const override { return cpu_.report(); }

  std::size_t first_moments() const { return first_moments_; }
  std::size_t again_moments() const { return again_moments_; }
  double first_evaluations() const { return first_evaluations_; }
  double again_evaluations() const { return again_evaluations_; }

 private:
  CpuEvaluator cpu_;
  bool has_double_;
  std::size_t first_moments_ = 0;
  std::size_t again_moments_ = 0;
  double first_evaluations_ = 0.0;
  double again_evaluations_ = 0.0;
};

void count_moments(RunPrediction& run, const Scene& scene, std::span<const SceneEntry> entries, const EffectPlan& plan,
                   bool has_double) {
  CountingEvaluator counting(scene.accuracy.precision, has_double);
  evaluate_scene(scene, drawn_entries(entries), plan, &counting, {});
  if (counting.first_moments() == 0) return;
  const double counted = static_cast<double>(counting.first_moments());
  const double scale = static_cast<double>(run.moments) / counted;
  run.first_evaluations = scale * counting.first_evaluations();
  run.again_share = static_cast<double>(counting.again_moments()) / counted;
  run.again_evaluations = scale * counting.again_evaluations();
  run.is_exact = counting.first_moments() == run.moments;
  run.counted_s = counting.report().kernel_s;
  run.counted_evaluations = counting.report().evaluations;
}

}  // namespace

RunPrediction predict_run(const Scene& scene, std::span<const SceneEntry> entries, const EffectPlan& plan,
                          bool has_double, const RequestVisitor& visit) {
  const std::vector<OpticalConstants> samples = spectral_rule(scene).indices();
  RunPrediction run;
  run.entries = entries.size();
  run.spectral_samples = samples.size();
  run.first = first_attempt(scene.accuracy, has_double);
  run.beams = plan.needs_beams ? entries.size() * samples.size() : 0;
  run.host_bytes = static_cast<double>(entries.size() * (sizeof(SceneEntry) + sizeof(PointResult)));
  if (!plan.needs_moments) return run;
  std::size_t largest = 0;
  for (const std::span<const SceneEntry> part : run_blocks(entries, samples.size())) {
    const Block block = moments_block(scene, samples, part, run.first);
    run.moments += block.request.entries.size();
    largest = std::max(largest, block.request.entries.size());
    if (visit) visit(block.request);
  }
  run.host_bytes += static_cast<double>(largest * (2 * sizeof(MomentsEntry) + sizeof(Moments)));
  count_moments(run, scene, entries, plan, has_double);
  return run;
}

}  // namespace dolp
