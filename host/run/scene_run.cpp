#include "run/scene_run.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <span>
#include <stdexcept>

#include "base/parallel_ranges.hpp"
#include "model/angles.hpp"
#include "model/status.hpp"
#include "plan/refinement.hpp"
#include "run/closed_forms.hpp"
#include "run/part_requests.hpp"
#include "run/table_scene.hpp"

namespace dolp {
namespace {

// Bound the memory of a run. Points take more of it, because nothing is shared between them.
constexpr std::size_t kMomentsAtOnce = 1U << 22U;
constexpr std::size_t kPointsAtOnce = 1U << 20U;
// A direction of which more than one entry in so many misses the tolerance is refined as a whole.
constexpr std::size_t kManyMisses = 8;
constexpr std::size_t kFewEntries = 256;      // whose levels are joined
constexpr std::size_t kEntriesAtOnce = 4096;  // of a thread: their radiometry takes longer than to start one

/// What the parts of a run share.
struct Way {
  const Scene& scene;
  const EffectPlan& plan;
  const Radiometry& radiometry;
  const std::vector<OpticalConstants>& samples;
  MomentsEvaluator* evaluator;
  Accuracy accuracy;  ///< the scene's, in the evaluator's precision where the scene leaves it open
};

/// What the evaluator said to the requests of a part.
struct Answer {
  std::vector<Moments> moments;
  std::vector<ScatteringMatrix> beams;
};

/// The first column of a pBRDF.
Scattered scattered(const ScatteringMatrix& f) { return {f.m[0], f.m[4], f.m[8], f.m[12], f.error}; }

/// Results of the members of a selection, one by one; the object keeps its memory between them.
class MemberResults {
 public:
  MemberResults(const Way& way, const Selection& selection, const PartRequests& requests, const Answer& answer)
      : way_(way),
        selection_(selection),
        requests_(requests),
        answer_(answer),
        moments_(way.samples.size()),
        indices_(way.samples.size()),
        beams_(way.samples.size()) {}

  PointResult operator()(std::size_t member) {
    const SceneEntry entry = selection_[member];
    const Direction direction = seen(entry);
    if (entry.index) std::ranges::fill(indices_, *entry.index);
    const std::span<const OpticalConstants> indices = entry.index ? indices_ : way_.samples;
    const std::span<const Moments> moments = moments_of(member, entry, direction, indices);
    if (way_.scene.geometry.mode != Mode::kBistatic) return way_.radiometry.point(direction, moments, indices);
    fill_beams(member, entry);
    return way_.radiometry.bistatic_point(direction, cos_sin_deg(entry.theta_deg).cos, moments, indices, beams_);
  }

 private:
  /// Neighbours in a grid mostly have one direction, and all of them one way to treat it.
  const Direction& seen(const SceneEntry& entry) {
    const Surface& surface = way_.scene.surface;
    const double theta_deg = seen_deg(way_.scene, entry.theta_deg);
    const Treatment treatment = treatment_of(surface.distribution, surface.masking, theta_deg, entry.shape);
    if (!has_direction_ || theta_deg != direction_.theta_deg || treatment != direction_.treatment) {
      direction_ = direction_of(surface.distribution, surface.masking, theta_deg, entry.shape);
      has_direction_ = true;
    }
    return direction_;
  }

  /// The answer, or closed forms, or zeros where the plan needs none.
  std::span<const Moments> moments_of(std::size_t member, const SceneEntry& entry, const Direction& direction,
                                      std::span<const OpticalConstants> indices) {
    if (!way_.plan.needs_moments) return moments_;  // never written to
    if (direction.treatment != Treatment::kIntegrated) {
      for (std::size_t j = 0; j < moments_.size(); ++j) {
        moments_[j] = closed_form(way_.scene.surface, direction, entry.shape, indices[j]);
      }
      return moments_;
    }
    const PartRequests::Place place = requests_.moments_of(member);
    if (place.stride == 1 || moments_.size() == 1) {
      return std::span(answer_.moments).subspan(place.first, moments_.size());
    }
    for (std::size_t j = 0; j < moments_.size(); ++j) moments_[j] = answer_.moments[place.first + j * place.stride];
    return moments_;
  }

  void fill_beams(std::size_t member, const SceneEntry& entry) {
    if (!way_.plan.needs_beams) return;
    if (!wants_beam(way_.scene, entry, way_.plan)) {
      std::ranges::fill(beams_, beam_without_evaluator(way_.scene, entry.theta_deg));
      return;
    }
    const std::size_t first = requests_.beams_of(member);
    for (std::size_t j = 0; j < beams_.size(); ++j) beams_[j] = scattered(answer_.beams[first + j]);
  }

  const Way& way_;
  const Selection& selection_;
  const PartRequests& requests_;
  const Answer& answer_;
  std::vector<Moments> moments_;
  std::vector<OpticalConstants> indices_;
  std::vector<Scattered> beams_;
  Direction direction_;
  bool has_direction_ = false;
};

/// A part of the progress of a whole: `before` of `total` are done when it starts.
Progress part_of(const Progress& progress, std::size_t before, std::size_t total) {
  return [&progress, before, total](std::size_t done, std::size_t) { return progress(before + done, total); };
}

/// Moments and beams of one level, in the same precision.
Answer asked(const Way& way, const PartRequests& requests, const Progress& progress) {
  const std::size_t moments = requests.moments().wanted_count();
  const std::size_t beams = requests.beams().entries.size();
  const std::size_t total = moments + beams;
  if (total == 0) return {};
  ScatteringEvaluator* const scattering = way.evaluator->scattering();
  if (beams > 0 && scattering == nullptr) throw std::logic_error("the bistatic mode needs an evaluator of pBRDFs");
  Answer answer;
  if (beams > 0 && moments > 0) scattering->prepare(requests.beams());
  if (moments > 0) answer.moments = way.evaluator->evaluate(requests.moments(), part_of(progress, 0, total));
  if (beams > 0) answer.beams = scattering->scatter(requests.beams(), part_of(progress, moments, total));
  return answer;
}

std::vector<PointResult> computed_at(const Way& way, const Selection& selection, const RefinementLevel& level,
                                     const Progress& progress) {
  const PartRequests requests(way.scene, way.samples, way.plan, selection, level);
  const Answer answer = asked(way, requests, progress);
  std::vector<PointResult> results(selection.size());
  parallel_ranges(results.size(), kEntriesAtOnce, [&](std::size_t first, std::size_t last) {
    MemberResults result_of(way, selection, requests, answer);
    for (std::size_t i = first; i < last; ++i) results[i] = result_of(i);
  });
  return results;
}

bool is_better(const PointResult& a, const PointResult& b) {
  return (a.status & kStatusToleranceMissed) < (b.status & kStatusToleranceMissed) ||
         std::max(a.error_estimate, a.rho_error_estimate) < std::max(b.error_estimate, b.rho_error_estimate);
}

/// Whether a level at an entry finds more than the last one: f has no rule that a tolerance would make finer.
bool finds_more(const Way& way, const RefinementLevel& level, const RefinementLevel& last, const SceneEntry& entry) {
  return wants_moments(way.scene, entry, way.plan) ||
         (wants_beam(way.scene, entry, way.plan) && level.precision != last.precision);
}

/// Entries waiting for the same level are computed together.
using Waiting = std::map<RefinementLevel, std::vector<std::size_t>>;

/// Whether entries that wait for the next level are better computed with the `count` before: a device waits longer for
/// few entries than it computes.
bool joins(const Waiting::value_type& next, const RefinementLevel& level, std::size_t count) {
  return next.first.precision == level.precision && !next.first.may_interpolate && !level.may_interpolate &&
         count + next.second.size() <= kFewEntries;
}

/// The next level of one direction whose `members` were computed at `last`: of all of it, between nodes again, where
/// many miss the tolerance; else of each of these by itself.
void plan_next(const Way& way, const SceneEntries& part, const RefinementLevel& last,
               std::span<const std::size_t> members, std::span<const PointResult> results, Waiting& waiting) {
  std::vector<std::pair<RefinementLevel, std::size_t>> missed;
  for (std::size_t j = 0; j < members.size(); ++j) {
    const auto next = next_level(last, results[j], way.accuracy, way.evaluator->has_double());
    if (next && finds_more(way, *next, last, part[members[j]])) missed.emplace_back(*next, members[j]);
  }
  if (last.may_interpolate && missed.size() * kManyMisses > members.size()) {
    const auto middle = missed.begin() + static_cast<std::ptrdiff_t>(missed.size() / 2);
    std::nth_element(missed.begin(), middle, missed.end());
    RefinementLevel next = middle->first;
    next.may_interpolate = true;
    std::vector<std::size_t>& all = waiting[next];
    all.insert(all.end(), members.begin(), members.end());
  } else {
    for (const auto& [next, member] : missed) waiting[next].push_back(member);
  }
}

/// Computes entries of a part that miss the tolerance again. To `progress` the part is done already; it may still
/// cancel.
void refine(const Way& way, const SceneEntries& part, const RefinementLevel& first, std::span<PointResult> results,
            const Progress& progress) {
  const Progress is_wanted = [&](std::size_t, std::size_t) { return progress(1, 1); };
  const std::size_t of_direction = part.is_grid() ? part.sigma().size() * part.q().size() : 1;
  Waiting waiting;
  const auto plan = [&](const RefinementLevel& last, std::span<const std::size_t> members,
                        std::span<const PointResult> found) {
    for (std::size_t i = 0; i < members.size(); i += of_direction) {
      const std::size_t count = std::min(of_direction, members.size() - i);
      plan_next(way, part, last, members.subspan(i, count), found.subspan(i, count), waiting);
    }
  };
  std::vector<std::size_t> all(results.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  plan(first, all, results);
  while (!waiting.empty()) {
    RefinementLevel level = waiting.begin()->first;
    std::vector<std::size_t> members = std::move(waiting.begin()->second);
    waiting.erase(waiting.begin());
    while (!waiting.empty() && joins(*waiting.begin(), level, members.size())) {
      level = waiting.begin()->first;
      const std::vector<std::size_t>& more = waiting.begin()->second;
      members.insert(members.end(), more.begin(), more.end());
      waiting.erase(waiting.begin());
    }
    const std::vector<PointResult> better = computed_at(way, {part, members}, level, is_wanted);
    for (std::size_t j = 0; j < members.size(); ++j) {
      if (is_better(better[j], results[members[j]])) results[members[j]] = better[j];
    }
    plan(level, members, better);
  }
}

/// Computes some entries of a grid again, after its first level, by a rule of another kind.
std::vector<PointResult> computed_again(const Way& way, const SceneEntries& part, const RefinementLevel& first,
                                        std::span<const std::size_t> positions) {
  if (positions.empty()) return {};
  const Progress none = [](std::size_t, std::size_t) { return true; };
  return computed_at(way, {part, positions}, check_level(first, way.evaluator->report().row_width), none);
}

/// Which entries of a part a run checks: none of points. `nodes`: moments between which the others were interpolated.
std::vector<std::size_t> positions_to_check(const Way& way, const SceneEntries& part, std::uint64_t nodes,
                                            std::size_t before) {
  if (!part.is_grid() || !way.plan.needs_moments) return {};
  const std::size_t integrated = nodes > 0 ? nodes : part.size() * way.samples.size();
  std::vector<std::size_t> positions =
      checked_positions(part.size(), checked_count(integrated), scene_seed(way.scene) + before);
  std::erase_if(positions, [&](std::size_t i) { return !wants_moments(way.scene, part[i], way.plan); });
  return positions;
}

/// Results of a part: all levels, or what needs none. `before`: entries of the parts before.
std::vector<PointResult> part_results(const Way& way, const SceneEntries& part, std::size_t before, SelfCheck& check,
                                      const Progress& progress) {
  if (!wants_evaluator(way.scene, part, way.plan)) {
    std::vector<PointResult> results = computed_at(way, {part}, {}, progress);
    if (!progress(1, 1)) throw Cancelled{};
    return results;
  }
  const RefinementLevel first = first_level(way.accuracy, way.evaluator->has_double());
  const std::uint64_t nodes_before = way.evaluator->report().interpolation_nodes;
  std::vector<PointResult> results = computed_at(way, {part}, first, progress);
  const std::uint64_t nodes = way.evaluator->report().interpolation_nodes - nodes_before;
  const std::vector<std::size_t> positions = positions_to_check(way, part, nodes, before);
  const std::vector<PointResult> again = computed_again(way, part, first, positions);
  RefinementLevel used = first;
  used.may_interpolate = nodes > 0;
  refine(way, part, used, results, progress);
  SelfCheck of_part;
  for (std::size_t i = 0; i < positions.size(); ++i) of_part.add(results[positions[i]], again[i]);
  if (of_part.worst_ratio > 1.0) {
    for (PointResult& result : results) result.status |= kStatusToleranceMissed;
  }
  check.add(of_part);
  return results;
}

}  // namespace

void CollectedResults::write(const SceneEntries&, std::vector<PointResult> results) {
  if (results_.empty()) {
    results_ = std::move(results);
  } else {
    results_.insert(results_.end(), results.begin(), results.end());
  }
}

std::vector<SceneEntries> run_parts(const SceneEntries& entries, std::size_t spectral_samples) {
  const std::size_t moments = entries.is_grid() ? kMomentsAtOnce : kPointsAtOnce;
  return entries.parts(std::max<std::size_t>(1, moments / spectral_samples));
}

bool wants_evaluator(const Scene& scene, const SceneEntries& entries, const EffectPlan& plan) {
  return std::ranges::any_of(entries.all(), [&](const SceneEntry& entry) {
    return wants_moments(scene, entry, plan) || wants_beam(scene, entry, plan);
  });
}

SelfCheck run_scene(const Scene& scene, const SceneEntries& entries, const EffectPlan& plan,
                    MomentsEvaluator* evaluator, Sink& sink, const Progress& progress) {
  const Radiometry radiometry(scene, plan.kept, plan.bound);
  const std::vector<OpticalConstants> samples = radiometry.rule().indices();
  Way way{scene, plan, radiometry, samples, evaluator, scene.accuracy};
  if (evaluator && way.accuracy.precision == Precision::kAuto) way.accuracy.precision = evaluator->precision();
  SelfCheck check;
  std::size_t before = 0;
  for (const SceneEntries& part : run_parts(entries, samples.size())) {
    const Progress part_progress = [&](std::size_t done, std::size_t total) {
      return !progress || progress(before + part.size() * done / total, entries.size());
    };
    sink.write(part, part_results(way, part, before, check, part_progress));
    before += part.size();
  }
  return check;
}

std::vector<PointResult> evaluate_scene(const Scene& scene, const SceneEntries& entries, const EffectPlan& plan,
                                        MomentsEvaluator* evaluator, const Progress& progress) {
  CollectedResults results;
  run_scene(scene, entries, plan, evaluator, results, progress);
  return results.take();
}

std::vector<PointResult> evaluate_scene(const Scene& scene, const SceneEntries& entries, MomentsEvaluator& evaluator,
                                        const Progress& progress) {
  return evaluate_scene(scene, entries, keep_everything(scene), &evaluator, progress);
}

}  // namespace dolp
