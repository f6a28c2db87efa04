#include "run/prediction.hpp"

#include <algorithm>
#include <vector>

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "evaluate/kernel/slope_samples.hpp"
#include "plan/moments_plan.hpp"
#include "run/estimates.hpp"
#include "run/part_requests.hpp"
#include "run/scene_run.hpp"
#include "table/table.hpp"

namespace dolp {
namespace {

constexpr std::size_t kDirectionBytes = 1000;  // pieces, nodes and positions that the kernels get
/// The axis from which a sample of directions draws zeniths: theta, unless moments are at several view zeniths.
Axis drawn_axis(const SceneValues& scene, const SceneEntries& grid) {
  return grid.axes()[moment_axis(scene)].empty() ? Axis::kTheta : moment_axis(scene);
}

/// The entries of `count` directions, spread evenly over the grid, at one temperature. If `has_responses`, they have
/// all wavelengths and indices of the grid, which share responses (see run_basis). Otherwise they have one of each.
SceneEntries entries_of_drawn_directions(const SceneEntries& grid, Axis drawn_from, std::size_t count,
                                         bool has_responses) {
  Axes axes = grid.axes();
  std::vector<double>& theta_deg = axes[drawn_from];
  std::ranges::sort(theta_deg);
  std::vector<double> drawn;
  for (std::size_t i = 0; i < count; ++i) drawn.push_back(theta_deg[(2 * i + 1) * theta_deg.size() / (2 * count)]);
  theta_deg = drawn;
  for (const Axis axis : kAllAxes) {
    if (axis >= Axis::kSigma || axis == drawn_from || axes[axis].empty()) continue;
    const bool is_whole = has_responses && axis < Axis::kViewZenith && axis != Axis::kTemperature;
    if (!is_whole) axes[axis] = {axes[axis][axes[axis].size() / 2]};
  }
  return SceneEntries::grid(axes, grid.index(), grid.slopes());
}

/// The work of all requests for moments or for beams. A run makes the requests of the first refinement level first.
struct Count {
  std::size_t first_requests = 0;  ///< number of requests of the first level that are still to come
  std::size_t first = 0;           ///< number of moments or beams in the first refinement level
  std::size_t again = 0;
  double first_evaluations = 0.0;
  double again_evaluations = 0.0;
  double spent_s = 0.0;

  void add(std::size_t entries, const EvaluationReport& before, const EvaluationReport& after) {
    const bool is_first = first_requests > 0;
    const double evaluations = after.evaluations - before.evaluations;
    (is_first ? first : again) += entries;
    (is_first ? first_evaluations : again_evaluations) += evaluations;
    if (is_first) --first_requests;
    spent_s += (after.kernel_s + after.beams_s) - (before.kernel_s + before.beams_s);
  }
};

class CountingEvaluator final : public ModelEvaluator {
 public:
  CountingEvaluator(bool has_double, std::size_t first_moments_requests)
      : has_double_(has_double), moments_{.first_requests = first_moments_requests}, beams_{.first_requests = 1} {}

  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override {
    const EvaluationReport before = cpu_.report();
    std::vector<Moments> moments = cpu_.evaluate(request, progress);
    moments_.add(request.size(), before, cpu_.report());
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

double count_ratio(std::size_t all, const Count& counted) {
  return counted.first == 0 ? 0.0 : static_cast<double>(all) / static_cast<double>(counted.first);
}

struct FirstLevel {
  FirstLevel(const SceneValues& scene, const SceneEntries& part, const EffectPlan& plan, const RefinementLevel& level)
      : indices(spectral_indices(plan, part)),
        requests(scene, indices, plan, {part}, level),
        moments(requests.moments()) {}
  std::size_t kernel_requests() const {
    std::size_t count = 0;
    for (const MomentsStep& step : moments.steps()) count += step.kernel_requests().size();
    return count;
  }
  SpectralIndices indices;
  PartRequests requests;
  MomentsPlan moments;
};

struct CountedPart {
  SceneEntries entries;
  Count moments;
  Count beams;
  double evaluations() const {
    return moments.first_evaluations + moments.again_evaluations + beams.first_evaluations + beams.again_evaluations;
  }
};

/// Computes a sample of `count` entries or, if the entries of a direction share work, of `count` directions.
CountedPart counted(const RunPrediction& run, const SceneValues& scene, const SceneEntries& entries,
                    const EffectPlan& plan, std::size_t count) {
  const SceneEntries drawn = run.counts_directions ? entries_of_drawn_directions(entries, drawn_axis(scene, entries),
                                                                                 count, run.first.basis != nullptr)
                                                   : drawn_entries(entries, count);
  CountedPart sample{run_parts(drawn, run.spectral_samples).front(), {}, {}};
  RefinementLevel level = run.first;
  level.basis = run_basis(scene, sample.entries, plan);
  CountingEvaluator counting(run.has_double, FirstLevel(scene, sample.entries, plan, level).kernel_requests());
  evaluate_scene(scene, sample.entries, counting, {}, plan);
  sample.moments = counting.moments();
  sample.beams = counting.beams();
  return sample;
}

/// The scene of the sample: with films or measured reflectances, it has only a part of each band.
struct CountedScene {
  SceneValues scene;
  EffectPlan plan;
  double band_share = 1.0;  ///< width of the part of a band, divided by the width of the band
};

/// A film of many fringes has so many spectral samples that one entry may take minutes. So the sample has a part of
/// each band, with about kCountedSamples spectral samples.
CountedScene counted_scene(const RunPrediction& run, const SceneValues& scene, const SceneEntries& entries,
                           const EffectPlan& plan) {
  CountedScene counted{scene, plan};
  if (scene.surface.is_bare() || run.first.basis || run.spectral_samples <= kCountedSamples) return counted;
  counted.band_share = static_cast<double>(kCountedSamples) / static_cast<double>(run.spectral_samples);
  const auto narrow = [&](Spectrum& band) {
    const double middle_um = 0.5 * (band.min_um + band.max_um);
    const double half_um = 0.5 * counted.band_share * (band.max_um - band.min_um);
    band = {middle_um - half_um, middle_um + half_um};
  };
  narrow(counted.scene.spectrum);
  for (Spectrum& band : counted.scene.bands) narrow(band);
  counted.plan.rules = nullptr;
  counted.plan = with_spectra(std::move(counted.plan), counted.scene, entries);
  return counted;
}

/// Counts the work of a small sample first, and then of larger samples, as far as the run allows it. Entries may differ
/// much in their work, so each sample decides whether a larger one is affordable.
CountedPart counted_sample(RunPrediction& run, const CountedScene& given, const SceneEntries& entries) {
  constexpr std::size_t kGrowth = 2;
  const std::size_t all = run.counts_directions ? entries.counts()[drawn_axis(given.scene, entries)] : entries.size();
  const std::size_t most = std::min(all, run.counts_directions ? kCountedDirections : kCountedEntries);
  const std::size_t entries_of_few = std::max<std::size_t>(1, kFewCountedMoments / run.spectral_samples);
  std::size_t count = run.counts_directions ? 1 : std::min(most, entries_of_few);
  while (true) {
    CountedPart sample = counted(run, given.scene, entries, given.plan, count);
    run.counted_evaluations += sample.evaluations();
    const double each = sample.evaluations() / static_cast<double>(count);
    const double allowed = allowed_evaluations(given.scene, each * static_cast<double>(all) / given.band_share);
    const double left = (allowed - run.counted_evaluations) / each;  // infinite if each is 0
    const double next = std::min(static_cast<double>(std::min(most, kGrowth * count)), left);
    if (next < static_cast<double>(count + 1)) return sample;
    count = static_cast<std::size_t>(next);
  }
}

void count_work(RunPrediction& run, const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan,
                std::size_t given) {
  const CountedPart sample = counted_sample(run, counted_scene(run, scene, entries, plan), entries);
  const Count& moments = sample.moments;
  const Count& beams = sample.beams;
  const double moments_scale = count_ratio(run.moments, moments);
  const double beams_scale = count_ratio(run.beams, beams);
  run.counted_entries = sample.entries.size();
  if (run.counts_directions) run.counted_directions = sample.entries.counts()[drawn_axis(scene, entries)];
  run.first_evaluations = moments_scale * moments.first_evaluations;
  run.again_evaluations = moments_scale * moments.again_evaluations;
  run.again_beams = beams_scale * static_cast<double>(beams.again);
  const double again = moments_scale * static_cast<double>(moments.again) + run.again_beams;
  run.again_share = again / static_cast<double>(std::max<std::size_t>(given, 1));
  run.is_exact = moments.first == run.moments && beams.first == run.beams;
  run.cpu_s = moments_scale * moments.spent_s + beams_scale * beams.spent_s;
}

std::size_t response_bytes(const MomentsStep& step) {
  std::size_t columns = 0;
  for (const MomentsRequest* request : step.kernel_requests())
    columns += request->response ? request->size() * request->response->count : 0;
  return columns * sizeof(ColumnMoments);
}

}  // namespace

double allowed_evaluations(const SceneValues& scene, double run_evaluations) {
  return std::max(scene.surface.is_bare() ? kFreeEvaluations : kFreeEvaluationsOfCurves, run_evaluations / kPlanShare);
}

RunPrediction predict_run(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& effects,
                          bool has_double, const RequestVisitor& visit) {
  const EffectPlan plan = with_spectra(effects, scene, entries);
  RunPrediction run;
  run.entries = entries.size();
  run.has_double = has_double;
  run.spectral_samples = plan.rules->most_samples(entries);
  run.first = first_level(scene.accuracy, has_double);
  std::size_t largest = 0, columns_before = 0, given = 0;
  run.first.basis = run_basis(scene, entries, plan);
  for (const SceneEntries& part : run_parts(entries, run.spectral_samples)) {
    const FirstLevel first(scene, part, plan, run.first);
    const std::size_t beams = first.requests.beams().entries.size();
    std::size_t largest_step = 0;
    run.interpolated += first.moments.saved_entries();
    run.moments += first.moments.kernel_moments();
    given += first.moments.size() + beams;
    for (const MomentsStep& step : first.moments.steps()) {
      largest_step = std::max(largest_step, response_bytes(step));
      for (const MomentsRequest* request : step.kernel_requests()) {
        run.counts_directions |= entries.is_grid() && (step.saves_work() || has_slope_samples(*request));
        visit(*request);
      }
    }
    run.beams += beams;
    // Columns of results take memory twice, because the previous part is still being written.
    const std::size_t columns = part.size() * sizeof(PointResult);
    const std::size_t directions = kDirectionBytes * (part.size() / part.entries_per_direction());
    largest = std::max(largest, columns + columns_before + directions + first.moments.size() * sizeof(Moments) +
                                    largest_step + beams * (sizeof(ScatteringEntry) + sizeof(ScatteringMatrix)));
    columns_before = columns;
  }
  run.host_bytes = static_cast<double>(largest);
  if (run.moments + run.beams > 0) count_work(run, scene, entries, plan, given);
  return run;
}

}  // namespace dolp
