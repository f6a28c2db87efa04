#include "run/scene_run.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <stdexcept>
#include <utility>

#include "base/parallel_ranges.hpp"
#include "model/angles.hpp"
#include "model/grazing.hpp"
#include "model/status.hpp"
#include "plan/attempts.hpp"
#include "run/beams.hpp"
#include "run/closed_forms.hpp"
#include "run/moments_block.hpp"

namespace dolp {
namespace {

constexpr std::size_t kMomentsAtOnce = 1U << 22U;  // bounds the memory of a run with many wavelengths
constexpr std::size_t kEntriesAtOnce = 4096;       // of a thread: their radiometry takes longer than to start one

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

/// What the evaluator said of the entries of a block.
struct BlockAnswer {
  const MomentsBlock& block;
  std::span<const Moments> moments;
  std::span<const Scattered> beams;  ///< the samples of each entry in turn, or nothing where the plan needs none
};

/// The cosine of the direction of one entry after the other; those of a grid have long runs of one direction.
class Cosine {
 public:
  double operator()(double theta_deg) {
    if (theta_deg != theta_deg_) {
      theta_deg_ = theta_deg;
      cosine_ = cos_sin_deg(theta_deg).cos;
    }
    return cosine_;
  }

 private:
  double theta_deg_ = 0.0;
  double cosine_ = 1.0;
};

/// Results of the entries of a block, one by one; the object keeps its memory between them.
class EntryResults {
 public:
  EntryResults(const SceneRun& run, const BlockAnswer& answer)
      : run_(run),
        answer_(answer),
        samples_(run.radiometry.rule().indices()),
        indices_(samples_.size()),
        moments_(samples_.size()),
        no_beams_(samples_.size()) {}

  PointResult operator()(const SceneEntry& entry, std::size_t position) {
    const SceneEntry seen = seen_entry(run_.scene, entry);
    const std::span<const Moments> moments = moments_of(seen, position);
    const Direction direction{seen.theta_deg, cosine_of(seen)};
    const std::span<const OpticalConstants> indices = indices_of(seen);
    if (!is_bistatic(run_.scene)) return run_.radiometry.point(direction, moments, indices);
    return run_.radiometry.bistatic_point(direction, source_cosine_(entry.theta_deg), moments, indices,
                                          beams_of(position));
  }

 private:
  std::span<const OpticalConstants> indices_of(const SceneEntry& seen) {
    if (!seen.index) return samples_;
    std::ranges::fill(indices_, *seen.index);
    return indices_;
  }

  double cosine_of(const SceneEntry& seen) {
    if (!needs_evaluator(run_.scene, seen)) return closed_form_cosine(seen);
    return cosine_(zenith_before_limit_deg(run_.scene.surface.masking, seen.theta_deg));
  }

  /// The moments of the entry at `position` of the block, or their closed forms, or zeros where the plan needs none.
  std::span<const Moments> moments_of(const SceneEntry& seen, std::size_t position) {
    if (!run_.plan.needs_moments) return moments_;  // never written to
    if (!needs_evaluator(run_.scene, seen)) {
      const std::span<const OpticalConstants> indices = indices_of(seen);
      moments_ = closed_forms(run_.scene, seen, {indices.begin(), indices.end()});
      return moments_;
    }
    const std::uint32_t first = answer_.block.first_moments[position];
    if (!seen.index) return answer_.moments.subspan(first, samples_.size());
    std::ranges::fill(moments_, answer_.moments[first]);
    return moments_;
  }

  std::span<const Scattered> beams_of(std::size_t position) const {
    if (answer_.beams.empty()) return no_beams_;
    return answer_.beams.subspan(position * samples_.size(), samples_.size());
  }

  const SceneRun& run_;
  const BlockAnswer& answer_;
  std::vector<OpticalConstants> samples_;
  std::vector<OpticalConstants> indices_;
  std::vector<Moments> moments_;
  std::vector<Scattered> no_beams_;
  Cosine cosine_, source_cosine_;
};

std::vector<Scattered> block_beams(const SceneRun& run, std::span<const SceneEntry> entries,
                                   std::span<const ScatteringMatrix> matrices) {
  if (!run.plan.needs_beams) return {};
  return entry_beams(run.scene, run.radiometry.rule().samples.size(), entries, matrices);
}

std::vector<PointResult> block_results(const SceneRun& run, std::span<const SceneEntry> entries,
                                       const BlockAnswer& answer) {
  std::vector<PointResult> results(entries.size());
  parallel_ranges(entries.size(), kEntriesAtOnce, [&](std::size_t first, std::size_t last) {
    EntryResults result_of(run, answer);
    for (std::size_t i = first; i < last; ++i) results[i] = result_of(entries[i], i);
  });
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
  MomentsBlock block;
  ScatteringRequest beams;
  if (all.run.plan.needs_moments) block = moments_block(scene, samples, entries, attempt);
  if (all.run.plan.needs_beams) beams = beams_request(scene, samples, entries, attempt.precision);
  const std::size_t before = block.request.entries.size();
  const std::size_t total = before + beams.entries.size();
  std::vector<Moments> moments;
  std::vector<ScatteringMatrix> matrices;
  ScatteringEvaluator* const scattering = all.evaluator.scattering();
  if (total > before && scattering == nullptr) throw std::logic_error("the bistatic mode needs an evaluator of pBRDFs");
  if (total > before && before > 0) scattering->prepare(beams);
  if (before > 0) moments = all.evaluator.evaluate(block.request, part_of(progress, 0, total));
  if (total > before) matrices = scattering->scatter(beams, part_of(progress, before, total));
  return block_results(all.run, entries, {block, moments, block_beams(all.run, entries, matrices)});
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
    std::vector<PointResult> results = block_results(run, entries, {{}, {}, block_beams(run, entries, {})});
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
  for (const std::span<const SceneEntry> block : run_blocks(entries, radiometry.rule().samples.size())) {
    const Progress block_progress = [&](std::size_t done, std::size_t total) {
      return !progress || progress(results.size() + block.size() * done / total, entries.size());
    };
    std::vector<PointResult> of_results = evaluated_block(run, block, evaluator, block_progress);
    if (results.empty()) {
      results = std::move(of_results);
    } else {
      results.insert(results.end(), of_results.begin(), of_results.end());
    }
  }
  return results;
}

std::vector<PointResult> evaluate_scene(const Scene& scene, const std::vector<SceneEntry>& entries,
                                        MomentsEvaluator& evaluator, const Progress& progress) {
  return evaluate_scene(scene, entries, keep_everything(scene), &evaluator, progress);
}

}  // namespace dolp
