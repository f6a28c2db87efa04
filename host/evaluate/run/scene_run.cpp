#include "evaluate/run/scene_run.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <stdexcept>

#include "evaluate/grazing.hpp"
#include "evaluate/run/attempts.hpp"
#include "evaluate/run/beams.hpp"
#include "evaluate/run/closed_forms.hpp"
#include "evaluate/run/moments_block.hpp"

namespace dolp {
namespace {

constexpr std::size_t kMomentsAtOnce = 1U << 22U;  // bounds the memory of a run with many wavelengths

bool is_bistatic(const Scene& scene) { return scene.geometry.mode == Mode::kBistatic; }

bool wants_moments(const Scene& scene, const SceneEntry& entry, const EffectPlan& plan) {
  return plan.needs_moments && needs_evaluator(scene, seen_entry(scene, entry));
}

bool wants_beam(const Scene& scene, const SceneEntry& entry, const EffectPlan& plan) {
  return plan.needs_beams && needs_scattering(scene, entry);
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

std::vector<Scattered> block_beams(const SceneRun& run, std::span<const SceneEntry> entries,
                                   std::span<const ScatteringMatrix> matrices) {
  if (!run.plan.needs_beams) return {};
  return entry_beams(run.scene, run.radiometry.rule().samples.size(), entries, matrices);
}

/// Results of the entries of a block.
/// Shape: `beams` has the samples of each entry in turn, or nothing where the plan needs none.
std::vector<PointResult> block_results(const SceneRun& run, std::span<const SceneEntry> entries, const Block& block,
                                       std::span<const Moments> moments, std::span<const Scattered> beams) {
  std::vector<PointResult> results;
  results.reserve(entries.size());
  const std::vector<OpticalConstants> samples = run.radiometry.rule().indices();
  const std::size_t count = samples.size();
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
    const std::span<const Scattered> own_beams = beams.empty() ? std::span(no_beams) : beams.subspan(i * count, count);
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

/// A part of the progress of a whole: `before` of `total` are done when it starts.
Progress part_of(const Progress& progress, std::size_t before, std::size_t total) {
  if (!progress) return {};
  return [&progress, before, total](std::size_t done, std::size_t) { return progress(before + done, total); };
}

/// One attempt at all entries of a block: moments and beams in the same precision.
std::vector<PointResult> attempt_block(const Attempts& all, std::span<const SceneEntry> entries, const Attempt& attempt,
                                       const Progress& progress) {
  const Scene& scene = all.run.scene;
  const std::vector<OpticalConstants> samples = all.run.radiometry.rule().indices();
  Block block;
  ScatteringRequest beams;
  if (all.run.plan.needs_moments) block = moments_block(scene, samples, entries, attempt);
  if (all.run.plan.needs_beams) beams = beams_request(scene, samples, entries, attempt.precision);
  const std::size_t before = block.request.entries.size();
  const std::size_t total = before + beams.entries.size();
  std::vector<Moments> moments;
  std::vector<ScatteringMatrix> matrices;
  if (before > 0) moments = all.evaluator.evaluate(block.request, part_of(progress, 0, total));
  if (total > before) {
    if (all.evaluator.scattering() == nullptr) throw std::logic_error("the bistatic mode needs an evaluator of pBRDFs");
    matrices = all.evaluator.scattering()->scatter(beams, part_of(progress, before, total));
  }
  return block_results(all.run, entries, block, moments, block_beams(all.run, entries, matrices));
}

bool is_better(const PointResult& a, const PointResult& b) {
  return (a.status & kStatusToleranceMissed) < (b.status & kStatusToleranceMissed) ||
         std::max(a.error_estimate, a.rho_error_estimate) < std::max(b.error_estimate, b.rho_error_estimate);
}

/// Whether an attempt at an entry finds more than the last one: f has no rule that a tolerance would make finer.
bool finds_more(const Attempt& attempt, const Attempt& last, const SceneRun& run, const SceneEntry& entry) {
  return wants_moments(run.scene, entry, run.plan) ||
         (wants_beam(run.scene, entry, run.plan) && attempt.precision != last.precision);
}

/// Tries the entries of a block again that miss the tolerance, those together that want the same attempt. To `progress`
/// the block is done already; it may still cancel.
void retry(const Attempts& all, std::span<const SceneEntry> entries, const Attempt& first,
           std::span<PointResult> results, const Progress& progress) {
  const Progress is_wanted = [&](std::size_t, std::size_t) { return progress(1, 1); };
  std::map<Attempt, std::vector<std::size_t>> waiting;
  const auto plan = [&](std::size_t i, const Attempt& last, const PointResult& result) {
    const auto next = next_attempt(last, result, all.accuracy, all.evaluator.has_double());
    if (next && finds_more(*next, last, all.run, entries[i])) waiting[*next].push_back(i);
  };
  for (std::size_t i = 0; i < entries.size(); ++i) plan(i, first, results[i]);
  while (!waiting.empty()) {
    const auto [attempt, members] = *waiting.begin();
    waiting.erase(waiting.begin());
    std::vector<SceneEntry> again;
    for (const std::size_t i : members) again.push_back(entries[i]);
    const std::vector<PointResult> better = attempt_block(all, again, attempt, is_wanted);
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
    std::vector<PointResult> results = block_results(run, entries, {}, {}, block_beams(run, entries, {}));
    if (!progress(1, 1)) throw Cancelled{};
    return results;
  }
  Attempts all{run, run.scene.accuracy, *evaluator};
  if (all.accuracy.precision == Precision::kAuto) all.accuracy.precision = evaluator->precision();
  const Attempt first = first_attempt(all.accuracy, evaluator->has_double());
  std::vector<PointResult> results = attempt_block(all, entries, first, progress);
  retry(all, entries, first, results, progress);
  return results;
}

}  // namespace

bool wants_evaluator(const Scene& scene, std::span<const SceneEntry> entries, const EffectPlan& plan) {
  return std::ranges::any_of(entries, [&](const SceneEntry& entry) {
    return wants_moments(scene, entry, plan) || wants_beam(scene, entry, plan);
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
