#include "run/scene_run.hpp"

#include <algorithm>
#include <cmath>
#include <dolp/errors.hpp>
#include <map>
#include <numeric>
#include <span>

#include <dolp/status.hpp>
#include "base/parallel_ranges.hpp"
#include "base/stopwatch.hpp"
#include "evaluate/planned_moments.hpp"
#include "evaluate/remembering_evaluator.hpp"
#include "model/angles.hpp"
#include "plan/further_light.hpp"
#include "plan/moments_plan.hpp"
#include "plan/refinement.hpp"
#include "run/closed_forms.hpp"
#include "run/derivatives.hpp"
#include "run/groove_table.hpp"
#include "run/part_requests.hpp"
#include "run/scene_table.hpp"
#include "run/table_scene.hpp"

namespace dolp {
namespace {

// Largest number of moments in a part of a grid. It keeps the memory small.
constexpr std::size_t kMomentsAtOnce = 1U << 20U;
// The same for directions of a grid, and for points, which have a direction each. A direction takes some 1000 bytes.
constexpr std::size_t kDirectionsAtOnce = 1U << 17U;
// If more than 1 in kWholeDirectionMissRatio entries of a direction misses the tolerance, the whole direction is
// computed again. Tuned. Evaluations per entry with smith masking at half, once and twice this value: 1.71, 1.81, 1.99.
constexpr std::size_t kWholeDirectionMissRatio = 8;
constexpr std::size_t kEntriesAtOnce = 4096;  // with fewer entries per thread, starting the thread does not pay

struct Spectra {
  Spectra(const SceneValues& scene, const EffectPlan& plan, const std::vector<SceneVariant>& variants,
          const ModelEvaluator* evaluator) {
    const TransmissionIntegral transmission = evaluator ? evaluator->transmission() : transmission_integral;
    for (const SceneVariant& variant : variants)
      radiometries.emplace_back(with_variant(scene, variant), *plan.rules->at(variant),
                                RadiometrySettings{plan.kept, plan.bound, plan.sky, transmission});
    for (const Radiometry& radiometry : radiometries) indices.push_back(radiometry.rule().indices());
  }
  std::vector<Radiometry> radiometries;
  SpectralIndices indices;
};

struct RunContext {
  const SceneValues& scene;
  const EffectPlan& plan;
  const Spectra& spectra;
  ModelEvaluator* evaluator;
  std::shared_ptr<const ResponseBasis> basis;
  Quantities quantities;                       ///< those that the run computes
  RunSummary& summary;                         ///< summary of the run so far
  std::shared_ptr<const GrooveTable> grooves;  ///< null for a list of points
};

struct EvaluatorResults {
  PlannedMoments moments;
  std::vector<ScatteringMatrix> beams;
};

/// The first column of the Mueller matrix of a pBRDF: Stokes parameters of the reflection of unpolarised light.
Scattered scattered(const ScatteringMatrix& f) { return {f.m[0], f.m[4], f.m[8], f.m[12], f.error}; }

class MemberResults {
 public:
  MemberResults(const RunContext& context, const Selection& selection, const PartRequests& requests,
                const EvaluatorResults& evaluated)
      : context_(context), selection_(selection), requests_(requests), evaluated_(evaluated), entries_(selection.part) {
    if (context.grooves) grooves_.emplace(*context.grooves, selection.part);
  }

  PointResult operator()(std::size_t member) {
    const SceneEntry& entry = entries_[selection_.position(member)];
    const Radiometry& radiometry = context_.spectra.radiometries[entry.variant];
    set_view(entry, radiometry);
    const std::span<const Moments> moments = member_moments(member, entry);
    if (context_.scene.geometry.mode == Mode::kBistatic) fill_beams(member, entry);
    PointResult result = radiometry.point(view_, moments, beams_);
    const double cos_theta = view_.direction.cos_theta;
    if (radiometry.may_change_dolp(result, cos_theta)) radiometry.judge_dolp(result, cos_theta, further(member, entry));
    return result;
  }

 private:
  std::span<const FurtherLight> further(std::size_t member, const SceneEntry& entry) {
    if (grooves_) return grooves_->at(selection_.position(member));
    further_.clear();
    const SlopeShape isotropic = mean_isotropic(entry.shape);  // enough for an estimate
    if (facets_.empty()) {
      const std::vector<FacetOptics>& optics = optics_->facets;
      const bool is_equal = entry.index && optics.front().is_bare();  // at all wavelengths
      for (const std::size_t j : middle_samples(is_equal ? 1 : optics.size())) facets_.emplace_back(optics[j]);
    }
    for (const GrooveFacet& facet : facets_)
      further_.push_back(
          further_light(context_.scene.surface.distribution, view_.direction.theta_deg, isotropic, facet));
    return further_;
  }

  /// Sets view_ and optics_, which neighbouring entries mostly share.
  void set_view(const SceneEntry& entry, const Radiometry& radiometry) {
    const Surface& surface = context_.scene.surface;
    const double theta_deg = moment_zenith_deg(context_.scene, entry);
    const Treatment treatment = choose_treatment(surface.distribution, surface.masking, theta_deg, entry.shape);
    const bool has_optics = optics_ && entry.variant == variant_ && entry.index == index_;
    if (has_optics && entry.theta_deg == theta_deg_ && theta_deg == view_.direction.theta_deg &&
        treatment == view_.direction.treatment)
      return;
    if (!has_optics) set_optics(entry, radiometry);
    theta_deg_ = entry.theta_deg;
    const Direction direction = make_direction(surface.distribution, surface.masking, theta_deg, entry.shape);
    view_ = radiometry.view(direction, *optics_, cos_sin_deg(entry.theta_deg).cos);
  }

  void set_optics(const SceneEntry& entry, const Radiometry& radiometry) {
    variant_ = entry.variant;
    index_ = entry.index;
    std::vector<FacetOptics> facets = context_.spectra.indices[entry.variant];
    if (moments_.size() != facets.size()) {
      moments_.assign(facets.size(), {});
      beams_.resize(facets.size());
      readers_.resize(facets.size(), MomentsReader(evaluated_.moments));
    }
    facets_.clear();
    optics_ = &radiometry.optics();
    if (!index_) return;
    for (FacetOptics& facet : facets) facet.index = *index_;
    own_optics_ = radiometry.optics_with(std::move(facets));
    optics_ = &own_optics_;
  }

  /// The moments of an entry: from the evaluator, from closed forms, or zeros if the plan needs no moments.
  std::span<const Moments> member_moments(std::size_t member, const SceneEntry& entry) {
    if (!context_.plan.kept.moments) return moments_;  // all zero, because nothing writes to moments_ in this case
    if (view_.direction.treatment != Treatment::kIntegrated) {
      for (std::size_t j = 0; j < moments_.size(); ++j) {
        moments_[j] = closed_form(context_.scene.surface, view_.direction, entry.shape, optics_->facets[j],
                                  context_.plan.sky.get());
      }
      return moments_;
    }
    const PartRequests::MomentsSpan span = requests_.member_moments(member, entries_.on_axes());
    if (moments_.size() == 1) return readers_.front().read(span.first, 1);
    for (std::size_t j = 0; j < moments_.size(); ++j) {
      MomentsReader& reader = readers_[span.stride == 0 ? 0 : j];
      moments_[j] = reader.read(span.first + j * span.stride, 1).front();
    }
    return moments_;
  }

  void fill_beams(std::size_t member, const SceneEntry& entry) {
    if (!context_.plan.needs_beams) return;
    if (!wants_beam(context_.scene, entry, context_.plan)) {
      std::ranges::fill(beams_, beam_without_evaluator(context_.scene, entry));
      return;
    }
    const std::size_t first = requests_.first_beam(member);
    for (std::size_t j = 0; j < beams_.size(); ++j) beams_[j] = scattered(evaluated_.beams[first + j]);
  }

  const RunContext& context_;
  const Selection& selection_;
  const PartRequests& requests_;
  const EvaluatorResults& evaluated_;
  EntryReader entries_;
  std::vector<Moments> moments_;
  std::vector<MomentsReader> readers_;  ///< one for each spectral sample
  std::vector<Scattered> beams_;
  std::optional<GrooveTable::Reader> grooves_;
  std::vector<FurtherLight> further_;
  // The next members belong to the last entry.
  std::uint32_t variant_ = 0;
  std::optional<OpticalConstants> index_;
  Radiometry::Optics own_optics_;  ///< with index_
  const Radiometry::Optics* optics_ = nullptr;
  std::vector<GrooveFacet> facets_;  ///< of the middle samples of optics_; empty until they are needed
  double theta_deg_ = 0.0;
  Radiometry::View view_;
};

/// Progress of a step within a larger task of `total` items. `before` items are done when the step starts.
Progress offset_progress(const Progress& progress, std::size_t before, std::size_t total) {
  return [&progress, before, total](std::size_t done, std::size_t) { return progress(before + done, total); };
}

/// For each direction of a grid: 1 if its moments are interpolated or sums of responses.
std::vector<char> interpolated_directions(const RunContext& context, const SceneEntries& grid,
                                          const PartRequests& requests, const MomentsPlan& plan) {
  const std::vector<char> saves = plan.saving_bundles();
  const std::size_t together = grid.entries_per_direction();
  std::vector<char> directions(grid.size() / together, 0);
  EntryReader reader(grid);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (!wants_moments(context.scene, reader[i], context.plan)) continue;
    const std::size_t entry = requests.member_moments(i, reader.on_axes()).first;
    directions[i / together] = saves[requests.moments().find_bundle(entry)];
    i += together - 1 - i % together;  // all entries of a direction are in one bundle for each index
  }
  return directions;
}

std::vector<ScatteringMatrix> evaluated_beams(const RunContext& context, const ScatteringRequest& request,
                                              const Progress& progress) {
  if (request.entries.empty()) return {};
  const EvaluationReport before = context.evaluator->report();
  const auto start = std::chrono::steady_clock::now();
  std::vector<ScatteringMatrix> beams = context.evaluator->scatter(request, progress);
  context.summary.work.transfer_s += transfer_time(before, context.evaluator->report(), seconds_since(start));
  return beams;
}

struct LevelResults {
  RefinementLevel level;
  RunResults results;
  std::vector<char> is_interpolated = {};  ///< one flag per direction of a whole part of a grid
};

LevelResults computed_at(const RunContext& context, const Selection& selection, const RefinementLevel& level,
                         const Progress& progress) {
  auto start = std::chrono::steady_clock::now();
  const PartRequests requests(context.scene, context.spectra.indices, context.plan, selection, level);
  MomentsPlan plan(requests.moments());
  context.summary.response_basis_s += seconds_since(start);
  LevelResults computed{level, {}};
  const std::size_t moments = requests.moments().size();
  const std::size_t total = moments + requests.beams().entries.size();
  if (moments > 0 && selection.is_whole_grid())
    computed.is_interpolated = interpolated_directions(context, selection.part, requests, plan);
  EvaluatorResults evaluated;
  if (moments > 0)
    evaluated.moments =
        planned_moments(std::move(plan), *context.evaluator, offset_progress(progress, 0, total), context.summary.work);
  evaluated.beams = evaluated_beams(context, requests.beams(), offset_progress(progress, moments, total));
  start = std::chrono::steady_clock::now();
  computed.results = RunResults(context.quantities, {}, selection.size());
  parallel_ranges(selection.size(), kEntriesAtOnce, [&](std::size_t first, std::size_t last) {
    MemberResults member_result(context, selection, requests, evaluated);
    for (std::size_t i = first; i < last; ++i) computed.results.set(i, member_result(i));
  });
  context.summary.radiometry_s += seconds_since(start);
  return computed;
}

bool is_better(const PointResult& a, const PointResult& b) {
  const auto misses = [](const PointResult& result) { return (result.status & kAnyToleranceNotMet) != 0; };
  return misses(a) < misses(b) || std::max(a[Quantity::kErrorEstimate], a[Quantity::kRhoErrorEstimate]) <
                                      std::max(b[Quantity::kErrorEstimate], b[Quantity::kRhoErrorEstimate]);
}

/// True if a tighter level makes the entry more accurate: if it has moments, or a beam that sums several bounces.
bool would_improve(const RunContext& context, const SceneEntry& entry) {
  const bool is_multiple = context.scene.surface.scattering == Scattering::kMultiple;
  return wants_moments(context.scene, entry, context.plan) ||
         (is_multiple && wants_beam(context.scene, entry, context.plan));
}

using EntriesByLevel = std::map<RefinementLevel, std::vector<std::size_t>>;

/// The refinement level for a whole direction, made from `next`, the level that one of its entries needs. If the run
/// uses responses (integrals that many refractive indices share), the level uses double precision if it may, because
/// float rounding disturbs responses. The tolerance is then the scene's tolerance divided by a power of 10. So more
/// directions with different indices get the same level.
RefinementLevel level_for_direction(RefinementLevel next, const RunContext& context) {
  next.may_interpolate = true;
  if (!context.basis) return next;
  const Accuracy& accuracy = context.scene.accuracy;
  const double decades = std::log10(accuracy.tolerance / next.tolerance);
  next.tolerance = accuracy.tolerance * std::pow(10.0, -std::ceil(decades - 0.1));
  if (context.evaluator->has_double() && accuracy.precision != Precision::kFloat) next.precision = Precision::kDouble;
  return next;
}

/// Queues entries of a direction (`members`) for later refinement levels. If `last` may interpolate and more than 1 in
/// kWholeDirectionMissRatio entries miss the tolerance, all entries are queued for one level that may interpolate too.
/// Otherwise each entry that misses the tolerance is queued for its own level, without interpolation.
void queue_refinement(const RunContext& context, const SceneEntries& part, const RefinementLevel& last,
                      std::span<const std::size_t> members, const RunResults& results, std::size_t first,
                      EntriesByLevel& by_level) {
  std::vector<std::pair<RefinementLevel, std::size_t>> missed;
  for (std::size_t j = 0; j < members.size(); ++j) {
    if ((results.status[first + j] & kAnyToleranceNotMet) == 0) continue;
    const auto next = next_level(last, results.at(first + j), context.scene.accuracy, context.evaluator->has_double());
    if (next && would_improve(context, part[members[j]])) missed.emplace_back(*next, members[j]);
  }
  if (last.may_interpolate && missed.size() * kWholeDirectionMissRatio > members.size()) {
    const auto middle = missed.begin() + static_cast<std::ptrdiff_t>(missed.size() / 2);
    std::nth_element(missed.begin(), middle, missed.end());
    std::vector<std::size_t>& all = by_level[level_for_direction(middle->first, context)];
    all.insert(all.end(), members.begin(), members.end());
  } else {
    for (const auto& [next, member] : missed) by_level[next].push_back(member);
  }
}

/// The level at which a part is computed first.
RefinementLevel level_for_parts(const RunContext& context) {
  RefinementLevel level = first_level(context.scene.accuracy, context.evaluator->has_double());
  if (context.evaluator->computes_each_entry()) level.may_interpolate = false;
  if (level.may_interpolate) level.basis = context.basis;
  return level;
}

/// Computes again the entries that miss the tolerance. They are counted already, so `progress` can only cancel here.
void refine(const RunContext& context, const SceneEntries& part, LevelResults& first, const Progress& progress) {
  const Progress is_wanted = [&](std::size_t, std::size_t) { return progress(1, 1); };
  const std::size_t entries_per_direction = part.entries_per_direction();
  RunResults& results = first.results;
  EntriesByLevel by_level;
  // The entries of one direction are neighbours in `members`.
  const auto plan = [&](RefinementLevel last, std::span<const std::size_t> members, const RunResults& found,
                        std::span<const char> is_interpolated) {
    for (std::size_t i = 0, end = 0; i < members.size(); i = end) {
      const std::size_t direction = members[i] / entries_per_direction;
      while (end < members.size() && members[end] / entries_per_direction == direction) ++end;
      if (!is_interpolated.empty()) last.may_interpolate = is_interpolated[direction] != 0;
      queue_refinement(context, part, last, members.subspan(i, end - i), found, i, by_level);
    }
  };
  std::vector<std::size_t> all(results.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  RefinementLevel last = first.level;
  last.may_interpolate = false;
  plan(last, all, results, first.is_interpolated);
  while (!by_level.empty()) {
    RefinementLevel level = by_level.begin()->first;
    const std::vector<std::size_t> members = std::move(by_level.begin()->second);
    by_level.erase(by_level.begin());
    if (level.may_interpolate) level.basis = context.basis;
    const RunResults better = computed_at(context, {part, members}, level, is_wanted).results;
    for (std::size_t j = 0; j < members.size(); ++j) {
      const PointResult result = better.at(j);
      if (is_better(result, results.at(members[j]))) results.set(members[j], result);
    }
    plan(level, members, better, {});
  }
}

RunResults recompute_for_check(const RunContext& context, const SceneEntries& part, const RefinementLevel& first,
                               std::span<const std::size_t> positions) {
  if (positions.empty()) return {};
  const Progress none = [](std::size_t, std::size_t) { return true; };
  const RunSummary before = context.summary;
  const EvaluationReport evaluated_before = context.evaluator->report();
  const auto start = std::chrono::steady_clock::now();
  RunResults results = computed_at(context, {part, positions}, check_level(first), none).results;
  // The times of the check become one time, so that they do not count twice.
  const EvaluationReport evaluated = context.evaluator->report();
  RunSummary& summary = context.summary;
  summary.check_s += seconds_since(start) - (evaluated.setup_s - evaluated_before.setup_s);
  summary.response_basis_s = before.response_basis_s;
  summary.radiometry_s = before.radiometry_s;
  for (double Work::*const time : {&Work::kernel_s, &Work::sums_s, &Work::curves_s, &Work::beams_s, &Work::transfer_s})
    summary.work.*time = before.work.*time - (evaluated.*time - evaluated_before.*time);
  return results;
}

/// `checked`: positions in the whole table or list. Returns the positions in `part` of the checked entries that have
/// moments.
std::vector<std::size_t> positions_in(const RunContext& context, const SceneEntries& part,
                                      std::span<const std::size_t> checked) {
  std::vector<std::size_t> positions;
  for (const std::size_t in_whole : checked) {
    const std::optional<std::size_t> position = part.find_position(in_whole);
    if (position && wants_moments(context.scene, part[*position], context.plan)) positions.push_back(*position);
  }
  return positions;
}

bool wants_evaluator(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan) {
  return std::ranges::any_of(entries.all(), [&](const SceneEntry& entry) {
    return wants_moments(scene, entry, plan) || wants_beam(scene, entry, plan);
  });
}

/// `positions`: entries that are computed a second time.
RunResults part_results(const RunContext& context, const SceneEntries& part, std::span<const std::size_t> positions,
                        SelfCheck& check, const Progress& progress) {
  if (!wants_evaluator(context.scene, part, context.plan)) {
    RunResults results = computed_at(context, {part}, {}, progress).results;
    if (!progress(1, 1)) throw Cancelled();
    return results;
  }
  LevelResults first = computed_at(context, {part}, level_for_parts(context), progress);
  RunResults& results = first.results;
  const RunResults again = recompute_for_check(context, part, first.level, positions);
  refine(context, part, first, progress);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    SelfCheck entry_check;
    entry_check.add(results.at(positions[i]), again.at(i));
    check.add(entry_check);
    if (entry_check.worst_ratio <= 1.0) continue;
    const std::size_t together = part.is_grid() ? part.entries_per_direction() : part.size();
    for (std::uint32_t& status : std::span(results.status).subspan(positions[i] / together * together, together))
      status |= kAnyToleranceNotMet;
  }
  return std::move(first.results);
}

}  // namespace

Sink CollectedResults::sink() {
  return [this](const SceneEntries& part, RunResults results, const RunSummary&) {
    if (part.size() == entries_.size()) {
      results_ = std::move(results);
      return;
    }
    if (results_.size() == 0) results_ = RunResults(results.quantities(), results.derivatives, entries_.size());
    part.for_each_run(entries_,
                      [&](const GridRun& run) { results_.copy(results, run.in_part, run.in_whole, run.count); });
  };
}

std::vector<SceneEntries> run_parts(const SceneEntries& entries, std::size_t spectral_samples) {
  const std::size_t moments = std::min(kMomentsAtOnce, kDirectionsAtOnce * entries.entries_per_direction());
  return entries.parts(std::max<std::size_t>(1, moments / spectral_samples));
}

void report_start(const Progress& progress, std::size_t total) {
  if (progress && !progress(0, total)) throw Cancelled();
}

Run::Run(const SceneValues& scene, SceneEntries entries, const RunOptions& options,
         const EvaluatorMaker& make_evaluator)
    : scene_(scene),
      entries_(std::move(entries)),
      derivative_keys_(options.derivatives),
      derivatives_(scene_derivatives(scene, entries_, derivative_keys_)),
      progress_(options.progress) {
  const SceneEntries whole = entries_.whole_entries();
  outcome_.plan = plan_effects(scene, whole, options.keep_all);
  outcome_.effects = list_effects(scene, whole, outcome_.plan);
  outcome_.spectral_rule_s = wall_s();
  report_start(progress_, entries_.size());
  if (!derivatives_.empty() || wants_evaluator(scene, entries_, outcome_.plan)) evaluator_ = make_evaluator();
  if (evaluator_) {
    outcome_.evaluation = evaluator_->report();
  } else {
    outcome_.evaluation.evaluator = outcome_.evaluation.device = outcome_.evaluation.precision = "none";
  }
}

std::vector<SceneEntries> Run::parts() const { return run_parts(entries_, plan().rules->most_samples(entries_)); }

void Run::add_derivatives(const SceneEntries& part, std::size_t done, RunResults& results) {
  const auto busy_s = [&] {
    const EvaluationReport report = evaluator_->report();
    return report.setup_s + report.kernel_s + report.sums_s + report.curves_s + report.beams_s;
  };
  const Progress is_wanted = [&](std::size_t, std::size_t) { return !progress_ || progress_(done, entries_.size()); };
  const double before_s = busy_s();
  const auto start = std::chrono::steady_clock::now();
  results.derivatives = derivatives_;
  for (std::size_t i = 0; i < derivative_keys_.size(); ++i) {
    compute_derivatives(scene_, part, derivative_keys_[i], *evaluator_, is_wanted,
                        std::span(results.derivatives).subspan(i * kDerivativesPerKey, kDerivativesPerKey));
  }
  outcome_.derivatives_s += std::max(0.0, seconds_since(start) - (busy_s() - before_s));
}

RunOutcome Run::compute(const Sink& sink, const Finished& finished) {
  std::size_t done = 0;
  const Sink with_derivatives = [&](const SceneEntries& part, RunResults results, const RunSummary& so_far) {
    done += part.size();
    if (!derivatives_.empty()) add_derivatives(part, done, results);
    sink(part, std::move(results), so_far);
  };
  outcome_.summary = run_scene(scene_, entries_, outcome_.plan, evaluator_, {with_derivatives, progress_, finished});
  if (evaluator_) {
    outcome_.evaluation = evaluator_->report();
    static_cast<Work&>(outcome_.evaluation) = outcome_.summary.work;
  }
  outcome_.wall_s = wall_s();
  return outcome_;
}

double Run::wall_s() const { return seconds_since(start_); }

RunSummary run_scene(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& given,
                     ModelEvaluator* evaluator, const RunOutput& output) {
  const EffectPlan plan = with_spectra(given, scene, entries);
  const Quantities quantities = output_quantities(scene, &plan, &entries);
  const std::size_t samples = plan.rules->most_samples(entries);
  const std::size_t whole = entries.whole_size();
  const bool has_moments = entries.is_grid() && plan.kept.moments;
  RunSummary summary = output.finished.summary;
  const auto start = std::chrono::steady_clock::now();
  const std::shared_ptr<const ResponseBasis> basis = evaluator ? run_basis(scene, entries, plan) : nullptr;
  summary.response_basis_s += seconds_since(start);
  std::vector<std::size_t> checked;
  if (has_moments || basis)
    checked = sample_positions(whole, checked_count(whole * samples) / samples, scene_seed(scene));
  const Surface& surface = scene.surface;
  const bool is_judged = has_moments && surface.scattering == Scattering::kSingle && !surface.has_cross_slopes();
  const auto grooves = is_judged ? std::make_shared<const GrooveTable>(scene, entries, *plan.rules) : nullptr;
  const auto with_evaluation = [&] {
    RunSummary all = summary;
    if (evaluator) all.work += evaluator->report();
    return all;
  };
  std::optional<RememberingEvaluator> remembering;
  const auto is_repeated = [](const MomentsRequest& request) {  // parts of a list have the same nodes
    return request.response && !request.is_scattered && !request.sky;
  };
  if (basis && !entries.is_grid()) evaluator = &remembering.emplace(*evaluator, is_repeated);
  std::size_t left = output.finished.parts, before = 0;
  for (const SceneEntries& part : run_parts(entries, samples)) {
    const Progress part_progress = [&](std::size_t done, std::size_t total) {
      return !output.progress || output.progress(before + part.size() * done / total, entries.size());
    };
    if (left > 0) {
      --left;
    } else {
      const auto spectra_start = std::chrono::steady_clock::now();
      const Spectra spectra(scene, plan, part.variants(), evaluator);
      summary.radiometry_s += seconds_since(spectra_start);
      const RunContext context{scene, plan, spectra, evaluator, basis, quantities, summary, grooves};
      const std::vector<std::size_t> positions = positions_in(context, part, checked);
      RunResults results = part_results(context, part, positions, summary.check, part_progress);
      summary.add(scene, part, results);
      output.sink(part, std::move(results), with_evaluation());
    }
    before += part.size();
  }
  return with_evaluation();
}

std::vector<PointResult> evaluate_scene(const SceneValues& scene, const SceneEntries& entries,
                                        ModelEvaluator& evaluator, const Progress& progress,
                                        const std::optional<EffectPlan>& plan) {
  CollectedResults results(entries);
  run_scene(scene, entries, plan ? *plan : keep_everything(scene), &evaluator, {results.sink(), progress});
  return results.take().list();
}

}  // namespace dolp
