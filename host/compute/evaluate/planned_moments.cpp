#include "evaluate/planned_moments.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "base/parallel_ranges.hpp"
#include "base/stopwatch.hpp"

namespace dolp {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kInterpolatedAtOnce = 1024;  // entries; their moments fit into the cache of a core

bool is_finite(const Moments& m) {
  return std::isfinite(m.r_i + m.r_q + m.albedo + m.deficit) &&
         std::isfinite(m.r_i_error + m.r_q_error + m.albedo_error + m.deficit_error);
}

/// The blocks of the step's bundles. Bundles with infinite or NaN moments have an empty block.
std::vector<ShapeBlock> shape_blocks(const MomentsStep& step, std::span<const Moments> nodes) {
  std::vector<ShapeBlock> blocks(step.bundles.size());
  parallel_for(blocks.size(), 16, [&](std::size_t i) {
    const Bundle& bundle = step.nodes().bundles[i];
    const std::span<const Moments> bundle_nodes = nodes.subspan(bundle.first_entry, bundle.count);
    if (std::ranges::all_of(bundle_nodes, is_finite)) blocks[i] = shape_block(*step.shapes, bundle_nodes);
  });
  return blocks;
}

/// Calls the evaluator for the requests of a plan, with one progress and one record of the work for all of them.
class Calls {
 public:
  Calls(const MomentsPlan& plan, ModelEvaluator& evaluator, const Progress& progress, Work& work)
      : plan_(plan), evaluator_(evaluator), progress_(progress), work_(work), kernel_moments_(plan.kernel_moments()) {}

  PlannedMoments::Step step(const MomentsStep& step) {
    std::vector<Moments> nodes = step.responses ? combined_nodes(step) : evaluated(step.nodes(), step.nodes().size());
    if (!step.shapes) {
      std::vector<std::size_t> first;
      for (const Bundle& bundle : step.request.bundles) first.push_back(bundle.first_entry);
      return {std::move(nodes), {}, std::move(first)};
    }
    const Clock::time_point start = Clock::now();
    std::vector<ShapeBlock> blocks = shape_blocks(step, nodes);
    work_.sums_s += seconds_since(start);
    return left_moments(step.request, std::move(blocks));
  }

 private:
  /// `planned`: number of moments by which the request advances the progress.
  std::vector<Moments> evaluated(const MomentsRequest& request, std::size_t planned) {
    const Progress plan_progress = [&](std::size_t done, std::size_t all) {
      const std::size_t so_far = done_ + planned * done / std::max<std::size_t>(all, 1);
      return !progress_ || progress_(plan_.size() * so_far / std::max<std::size_t>(kernel_moments_, 1), plan_.size());
    };
    const EvaluationReport before = evaluator_.report();
    const Clock::time_point start = Clock::now();
    std::vector<Moments> moments = evaluator_.evaluate(request, plan_progress);
    work_.transfer_s += transfer_time(before, evaluator_.report(), seconds_since(start));
    done_ += planned;
    return moments;
  }

  std::vector<Moments> combined_nodes(const MomentsStep& step) {
    std::vector<std::vector<Moments>> passes;
    for (const MomentsRequest& pass : step.responses->passes) passes.push_back(evaluated(pass, pass.size()));
    std::vector<Moments> others;
    if (const auto& request = step.responses->others) others = evaluated(*request, request->size());
    const Clock::time_point start = Clock::now();
    std::vector<Moments> moments = combined(step.nodes(), *step.responses, passes, others);
    work_.sums_s += seconds_since(start);
    return moments;
  }

  /// Computes the moments of the bundles that have no block.
  PlannedMoments::Step left_moments(const MomentsRequest& request, std::vector<ShapeBlock> blocks) {
    PlannedMoments::Step step{{}, std::move(blocks), std::vector<std::size_t>(request.bundles.size())};
    std::vector<std::size_t> left;
    std::size_t entries = 0;
    for (std::size_t i = 0; i < step.blocks.size(); ++i) {
      if (!step.blocks[i].is_empty()) continue;
      left.push_back(i);
      step.first[i] = entries;
      entries += request.bundles[i].count;
    }
    if (left.empty()) return step;
    MomentsRequest selected = request.select_bundles(left);
    selected.basis = nullptr;
    work_.interpolated -= entries;
    step.moments = evaluated(selected, 0);
    return step;
  }

  const MomentsPlan& plan_;
  ModelEvaluator& evaluator_;
  const Progress& progress_;
  Work& work_;
  std::size_t kernel_moments_;
  std::size_t done_ = 0;
};

}  // namespace

PlannedMoments::PlannedMoments(MomentsPlan plan, std::vector<Step> steps)
    : plan_(std::move(plan)), steps_(std::move(steps)), places_(plan_.bundles()) {
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const MomentsStep& step = plan_.steps()[i];
    for (std::size_t j = 0; j < step.bundles.size(); ++j)
      places_[step.bundles[j]] = {step.request.bundles[j].count, i, j};
  }
  std::size_t first = 0;
  for (Place& place : places_) first += std::exchange(place.first_entry, first);
}

PlannedMoments::Range PlannedMoments::read(std::size_t entry, std::vector<Moments>& buffer) const {
  if (steps_.size() == 1 && steps_.front().blocks.empty()) return {0, steps_.front().moments};
  const Place& place = *(std::ranges::upper_bound(places_, entry, {}, &Place::first_entry) - 1);
  const Step& step = steps_[place.step];
  const MomentsStep& planned = plan_.steps()[place.step];
  const std::size_t count = planned.request.bundles[place.position].count;
  if (step.blocks.empty() || step.blocks[place.position].is_empty())
    return {place.first_entry, std::span(step.moments).subspan(step.first[place.position], count)};
  const auto qs = static_cast<std::size_t>(planned.shapes->q.weights.cols());
  const std::size_t sigma = (entry - place.first_entry) / qs, q = (entry - place.first_entry) % qs;
  ShapeRange range{.first_q = q - q % kInterpolatedAtOnce};
  range.qs = std::min(kInterpolatedAtOnce, qs - range.first_q);
  const std::size_t sigmas_at_once = std::max<std::size_t>(kInterpolatedAtOnce / qs, 1);
  range.first_sigma = sigma - sigma % sigmas_at_once;
  range.sigmas = std::min(sigmas_at_once, count / qs - range.first_sigma);
  buffer.resize(range.sigmas * range.qs);
  interpolate(*planned.shapes, step.blocks[place.position], range, buffer);
  return {place.first_entry + range.first_sigma * qs + range.first_q, buffer};
}

std::vector<Moments> PlannedMoments::all() const {
  std::vector<Moments> all, buffer;
  while (all.size() < plan_.size()) {
    const std::span<const Moments> more = read(all.size(), buffer).moments;
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

PlannedMoments planned_moments(MomentsPlan plan, ModelEvaluator& evaluator, const Progress& progress, Work& work) {
  if (plan.size() == 0) return {};
  work.interpolated += plan.saved_entries();
  work.interpolation_nodes += plan.nodes_of_saved();
  Calls calls(plan, evaluator, progress, work);
  std::vector<PlannedMoments::Step> steps;
  for (const MomentsStep& step : plan.steps()) steps.push_back(calls.step(step));
  return {std::move(plan), std::move(steps)};
}

}  // namespace dolp
