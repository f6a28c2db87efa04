#include "evaluate/run/scene_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include "evaluate/grazing.hpp"
#include "evaluate/run/attempts.hpp"
#include "evaluate/run/closed_forms.hpp"
#include "evaluate/run/distinct.hpp"
#include "evaluate/run/moments_block.hpp"
#include "evaluate/run/scattering.hpp"

namespace dolp {
namespace {

constexpr std::size_t kMomentsAtOnce = 1U << 22U;  // bounds the memory of a run with many wavelengths

bool is_bistatic(const Scene& scene) { return scene.geometry.mode == Mode::kBistatic; }

/// What the source sends toward the view for each entry and sample; nothing for a mirror but toward its specular
/// direction, where the radiance is not defined.
std::vector<Scattered> entry_beams(const Scene& scene, std::span<const SceneEntry> entries,
                                   const std::vector<OpticalConstants>& samples) {
  MomentsRequest request;
  request.distribution = scene.surface.distribution;
  request.masking = scene.surface.masking;
  Distinct<double> thetas(request.theta_deg);
  Distinct<SlopeShape> shapes(request.shapes);
  Distinct<OpticalConstants> indices(request.indices);
  for (const SceneEntry& entry : entries) {
    if (is_mirror(entry.shape)) continue;
    MomentsEntry wanted;
    wanted.theta = thetas.position({entry.theta_deg, 0.0}, entry.theta_deg);
    wanted.shape = shapes.position({entry.shape.sigma, entry.shape.q}, entry.shape);
    for (const OpticalConstants& sample : samples) {
      const OpticalConstants index = entry.index.value_or(sample);
      wanted.index = indices.position({index.n, index.k}, index);
      request.entries.push_back(wanted);
    }
  }
  const Geometry& geometry = scene.geometry;
  const std::vector<Scattered> rough = scattered_beams(
      request, zenith_before_limit_deg(scene.surface.masking, geometry.view_zenith_deg), geometry.relative_azimuth_deg);
  std::vector<Scattered> beams;
  auto next = rough.begin();
  for (const SceneEntry& entry : entries) {
    for (std::size_t j = 0; j < samples.size(); ++j) {
      const bool is_specular =
          std::abs(geometry.relative_azimuth_deg) == 180.0 && entry.theta_deg == geometry.view_zenith_deg;
      const double glare = is_specular ? std::numeric_limits<double>::quiet_NaN() : 0.0;
      beams.push_back(is_mirror(entry.shape) ? Scattered{.i = glare, .q = glare} : *next++);
    }
  }
  return beams;
}

/// What the entries of a scene share.
struct SceneRun {
  const Scene& scene;
  const EffectPlan& plan;
  const Radiometry& radiometry;
};

/// Moments of one entry, and the direction that they are for.
struct EntryMoments {
  Direction direction;
  std::vector<Moments> moments;  ///< one for each spectral sample
};

/// The moments of the entry at `position` of a block, or their closed forms, or zeros where the plan needs none.
EntryMoments entry_moments(const SceneRun& run, const SceneEntry& seen, const std::vector<OpticalConstants>& indices,
                           const Block& block, std::size_t position, std::span<const Moments> moments) {
  if (!needs_evaluator(run.scene, seen)) {
    const Direction direction{seen.theta_deg, closed_form_cosine(seen)};
    if (!run.plan.needs_moments) return {direction, std::vector<Moments>(indices.size())};
    return {direction, closed_forms(run.scene, seen, indices)};
  }
  const double theta_deg = zenith_before_limit_deg(run.scene.surface.masking, seen.theta_deg);
  const Direction direction{seen.theta_deg, cos_sin_deg(theta_deg).cos};
  if (!run.plan.needs_moments) return {direction, std::vector<Moments>(indices.size())};
  const std::uint32_t first = block.first_moments[position];
  if (seen.index) return {direction, std::vector<Moments>(indices.size(), moments[first])};
  const std::span<const Moments> own = moments.subspan(first, indices.size());
  return {direction, {own.begin(), own.end()}};
}

/// Results of the entries of a block.
std::vector<PointResult> block_results(const SceneRun& run, std::span<const SceneEntry> entries, const Block& block,
                                       std::span<const Moments> moments) {
  std::vector<PointResult> results;
  results.reserve(entries.size());
  const std::vector<OpticalConstants> samples = run.radiometry.rule().indices();
  const std::size_t count = samples.size();
  const std::vector<Scattered> beams =
      run.plan.needs_beams ? entry_beams(run.scene, entries, samples) : std::vector<Scattered>{};
  const std::vector<Scattered> no_beams(count);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const SceneEntry seen = seen_entry(run.scene, entries[i]);
    const std::vector<OpticalConstants> indices =
        seen.index ? std::vector<OpticalConstants>(count, *seen.index) : samples;
    const EntryMoments own = entry_moments(run, seen, indices, block, i, moments);
    if (!is_bistatic(run.scene)) {
      results.push_back(run.radiometry.point(own.direction, own.moments, indices));
      continue;
    }
    const std::span<const Scattered> own_beams =
        beams.empty() ? std::span(no_beams) : std::span(beams).subspan(i * count, count);
    results.push_back(run.radiometry.bistatic_point(own.direction, cos_sin_deg(entries[i].theta_deg).cos, own.moments,
                                                    indices, own_beams));
  }
  return results;
}

/// What the attempts at the entries of a scene share.
struct Attempts {
  const SceneRun& run;
  Accuracy accuracy;  ///< the scene's, in the evaluator's precision where the scene leaves it open
  MomentsEvaluator& evaluator;
};

/// One attempt at all entries of a block.
std::vector<PointResult> attempt_block(const Attempts& all, std::span<const SceneEntry> entries, const Attempt& attempt,
                                       const Progress& progress) {
  const Block block = moments_block(all.run.scene, all.run.radiometry.rule().indices(), entries, attempt);
  const std::vector<Moments> moments = all.evaluator.evaluate(block.request, progress);
  return block_results(all.run, entries, block, moments);
}

bool is_better(const PointResult& a, const PointResult& b) {
  return (a.status & kStatusToleranceMissed) < (b.status & kStatusToleranceMissed) ||
         std::max(a.error_estimate, a.rho_error_estimate) < std::max(b.error_estimate, b.rho_error_estimate);
}

/// Tries the entries of a block again that miss the tolerance, those together that want the same attempt.
void retry(const Attempts& all, std::span<const SceneEntry> entries, const Attempt& first,
           std::span<PointResult> results) {
  std::map<Attempt, std::vector<std::size_t>> waiting;
  const auto plan = [&](std::size_t i, const Attempt& last, const PointResult& result) {
    const auto next = next_attempt(last, result, all.accuracy, all.evaluator.has_double());
    if (next && needs_evaluator(all.run.scene, seen_entry(all.run.scene, entries[i]))) waiting[*next].push_back(i);
  };
  for (std::size_t i = 0; i < entries.size(); ++i) plan(i, first, results[i]);
  while (!waiting.empty()) {
    const auto [attempt, members] = *waiting.begin();
    waiting.erase(waiting.begin());
    std::vector<SceneEntry> again;
    for (const std::size_t i : members) again.push_back(entries[i]);
    const std::vector<PointResult> better = attempt_block(all, again, attempt, {});
    for (std::size_t j = 0; j < members.size(); ++j) {
      if (is_better(better[j], results[members[j]])) results[members[j]] = better[j];
      plan(members[j], attempt, better[j]);
    }
  }
}

/// Results of a block: all attempts, or what needs none.
std::vector<PointResult> evaluated_block(const SceneRun& run, std::span<const SceneEntry> entries,
                                         MomentsEvaluator* evaluator, const Progress& progress) {
  if (!wants_evaluator(run.scene, entries, run.plan)) {
    std::vector<PointResult> results = block_results(run, entries, {}, {});
    if (!progress(1, 1)) throw Cancelled{};
    return results;
  }
  Attempts all{run, run.scene.accuracy, *evaluator};
  if (all.accuracy.precision == Precision::kAuto) all.accuracy.precision = evaluator->precision();
  const Attempt first = first_attempt(all.accuracy, evaluator->has_double());
  std::vector<PointResult> results = attempt_block(all, entries, first, progress);
  retry(all, entries, first, results);
  return results;
}

}  // namespace

bool wants_evaluator(const Scene& scene, std::span<const SceneEntry> entries, const EffectPlan& plan) {
  return plan.needs_moments && std::ranges::any_of(entries, [&](const SceneEntry& entry) {
           return needs_evaluator(scene, seen_entry(scene, entry));
         });
}

std::vector<std::span<const SceneEntry>> run_blocks(std::span<const SceneEntry> entries, std::size_t spectral_samples) {
  const std::size_t block_size = std::max<std::size_t>(1, kMomentsAtOnce / spectral_samples);
  std::vector<std::span<const SceneEntry>> blocks;
  for (std::size_t first = 0; first < entries.size(); first += block_size) {
    blocks.push_back(entries.subspan(first, std::min(block_size, entries.size() - first)));
  }
  return blocks;
}

std::vector<PointResult> evaluate_scene(const Scene& scene, const std::vector<SceneEntry>& entries,
                                        const EffectPlan& plan, MomentsEvaluator* evaluator, const Progress& progress) {
  const Radiometry radiometry(scene, plan.kept, plan.bound);
  const SceneRun run{scene, plan, radiometry};
  std::vector<PointResult> results;
  results.reserve(entries.size());
  for (const std::span<const SceneEntry> block : run_blocks(entries, radiometry.rule().samples.size())) {
    const Progress block_progress = [&](std::size_t done, std::size_t total) {
      return !progress || progress(results.size() + block.size() * done / total, entries.size());
    };
    std::vector<PointResult> of_results = evaluated_block(run, block, evaluator, block_progress);
    results.insert(results.end(), of_results.begin(), of_results.end());
  }
  return results;
}

std::vector<PointResult> evaluate_scene(const Scene& scene, const std::vector<SceneEntry>& entries,
                                        MomentsEvaluator& evaluator, const Progress& progress) {
  return evaluate_scene(scene, entries, keep_everything(scene), &evaluator, progress);
}

}  // namespace dolp
