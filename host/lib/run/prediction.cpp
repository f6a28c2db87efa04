#include "run/prediction.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "evaluate/interpolation/interpolating_evaluator.hpp"
#include "evaluate/kernel/slope_samples.hpp"
#include "plan/response_plan.hpp"
#include "plan/shape_plan.hpp"
#include "run/drawn_entries.hpp"
#include "run/part_requests.hpp"
#include "run/response_bases.hpp"
#include "run/scene_run.hpp"
#include "table/table.hpp"

namespace dolp {
namespace {

/// All slope distributions of some directions of a grid, the middles of equal parts of them, at one wavelength and
/// index.
SceneEntries entries_of_drawn_directions(const SceneEntries& grid) {
  Axes axes = grid.axes();
  std::vector<double>& theta_deg = axes[Axis::kTheta];
  std::ranges::sort(theta_deg);
  std::vector<double> drawn;
  const std::size_t count = std::min(theta_deg.size(), kCountedDirections);
  for (std::size_t i = 0; i < count; ++i) drawn.push_back(theta_deg[(2 * i + 1) * theta_deg.size() / (2 * count)]);
  theta_deg = drawn;
  for (const Axis axis : {Axis::kWavelength, Axis::kN, Axis::kK}) {
    if (!axes[axis].empty()) axes[axis] = {axes[axis][axes[axis].size() / 2]};
  }
  return SceneEntries::of_grid(axes, grid.index());
}

/// Sums of one kind of request, of the first level and of all others.
struct Count {
  bool is_first = true;   ///< until the first level has made its request
  std::size_t first = 0;  ///< moments or beams
  std::size_t again = 0;
  double first_evaluations = 0.0;
  double again_evaluations = 0.0;
  double spent_s = 0.0;

  void add(std::size_t entries, const EvaluationReport& before, const EvaluationReport& after) {
    const double evaluations = after.evaluations - before.evaluations;
    (is_first ? first : again) += entries;
    (is_first ? first_evaluations : again_evaluations) += evaluations;
    is_first = false;
    spent_s += after.kernel_s - before.kernel_s;
  }
};

/// Records the requests of a run's levels.
class CountingEvaluator final : public ModelEvaluator {
 public:
  explicit CountingEvaluator(bool has_double) : has_double_(has_double) {}

  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override {
    const EvaluationReport before = cpu_.report();
    std::vector<Moments> moments = cpu_.evaluate(request, progress);
    moments_.add(request.wanted_count(), before, cpu_.report());
    return moments;
  }
  std::vector<ScatteringMatrix> scatter(const ScatteringRequest& request, const Progress& progress) override {
    const EvaluationReport before = cpu_.report();
    std::vector<ScatteringMatrix> matrices = cpu_.scatter(request, progress);
    beams_.add(request.entries.size(), before, cpu_.report());
    return matrices;
  }
  bool has_double() const override { return has_double_; }
  EvaluationReport report() const override { return cpu_.report(); }

  const Count& moments() const { return moments_; }
  const Count& beams() const { return beams_; }

 private:
  CpuEvaluator cpu_;
  bool has_double_;
  Count moments_;
  Count beams_;
};

/// The number of all entries for each counted one.
double scale_of(std::size_t all, const Count& counted) {
  return counted.first == 0 ? 0.0 : static_cast<double>(all) / static_cast<double>(counted.first);
}

void count_work(RunPrediction& run, const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan,
                bool has_double) {
  const SceneEntries drawn =
      run.counts_directions ? entries_of_drawn_directions(entries) : drawn_entries(entries, kCountedEntries);
  auto owned = std::make_unique<CountingEvaluator>(has_double);
  const CountingEvaluator& counting = *owned;
  InterpolatingEvaluator interpolating(std::move(owned));
  evaluate_scene(scene, drawn, interpolating, {}, plan);
  const Count& moments = counting.moments();
  const Count& beams = counting.beams();
  const double moments_scale = scale_of(run.moments, moments);
  const double beams_scale = scale_of(run.beams, beams);
  run.first_evaluations = moments_scale * moments.first_evaluations;
  run.again_evaluations = moments_scale * moments.again_evaluations;
  run.again_beams = beams_scale * static_cast<double>(beams.again);
  const double again = moments_scale * static_cast<double>(moments.again) + run.again_beams;
  if (run.moments + run.beams > 0) run.again_share = again / static_cast<double>(run.moments + run.beams);
  run.is_exact = moments.first == run.moments && beams.first == run.beams;
  run.moments_s = moments_scale * moments.spent_s;
  run.beams_s = beams_scale * beams.spent_s;
}

/// The requests that a request of one shape parameter is computed by.
std::vector<MomentsRequest> computed_requests(const MomentsRequest& request) {
  const std::optional<ShapePlan> shapes = shape_plan(request);
  const MomentsRequest& nodes = shapes ? shapes->nodes : request;
  if (!nodes.basis) return {nodes};
  ResponsePlan plan = response_plan(nodes);
  if (plan.others) plan.passes.push_back(*std::move(plan.others));
  return std::move(plan.passes);
}

}  // namespace

RunPrediction predict_run(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan,
                          bool has_double, const RequestVisitor& visit) {
  RunPrediction run;
  run.entries = entries.size();
  run.spectral_samples = spectral_rule(scene).samples.size();
  run.first = first_level(scene.accuracy, has_double);
  std::size_t largest = 0, columns_before = 0;
  run.first.basis = ResponseBases(scene, entries, plan).of(run.first);
  for (const SceneEntries& part : run_parts(entries, run.spectral_samples)) {
    const SpectralIndices indices = spectral_indices(scene, part);
    const PartRequests requests(scene, indices, plan, {part}, run.first);
    const std::size_t moments = requests.moments().size();
    const std::size_t beams = requests.beams().entries.size();
    for (const MomentsRequest& asked : with_one_parameter(requests.moments())) {
      if (asked.size() == 0) continue;
      const bool is_interpolated = asked.basis || shape_plan(asked);
      if (is_interpolated) run.interpolated += asked.size();
      for (const MomentsRequest& computed : computed_requests(asked)) {
        run.counts_directions = entries.is_grid() && (is_interpolated || has_slope_samples(computed));
        run.moments += computed.size();
        visit.moments(computed);
      }
    }
    run.beams += beams;
    if (beams > 0) visit.beams(requests.beams());
    // Memory of the results, the columns made of them, and those of the part before, which are being written.
    const std::size_t columns = part.size() * (kQuantityCount * sizeof(double) + sizeof(std::uint32_t));
    largest =
        std::max(largest, part.size() * sizeof(PointResult) + columns + columns_before + moments * sizeof(Moments) +
                              beams * (sizeof(ScatteringEntry) + sizeof(ScatteringMatrix)));
    columns_before = columns;
  }
  run.host_bytes = static_cast<double>(largest);
  if (run.moments + run.beams > 0) count_work(run, scene, entries, plan, has_double);
  return run;
}

}  // namespace dolp
