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

/// The blocks of the wanted pairs of an index and a direction. Pairs with infinite or NaN moments have an empty block.
std::vector<ShapeBlock> shape_blocks(const MomentsStep& step, std::span<const Moments> nodes) {
  const std::size_t nodes_per_pair = step.shapes->nodes_of_a_direction();
  std::vector<ShapeBlock> blocks(nodes.size() / nodes_per_pair);
  parallel_for(blocks.size(), 16, [&](std::size_t i) {
    const std::span<const Moments> pair_nodes = nodes.subspan(i * nodes_per_pair, nodes_per_pair);
    const bool is_wanted = step.request.is_wanted(i * step.request.shapes());
    if (is_wanted && std::ranges::all_of(pair_nodes, is_finite)) blocks[i] = shape_block(*step.shapes, pair_nodes);
  });
  return blocks;
}

/// Calls the evaluator for the requests of a plan, with one progress and one record of the work for all of them.
class Calls {
 public:
  Calls(const MomentsPlan& plan, ModelEvaluator& evaluator, const Progress& progress, Work& work)
      : plan_(plan), evaluator_(evaluator), progress_(progress), work_(work), kernel_moments_(plan.kernel_moments()) {}

  PlannedMoments::Step step(const MomentsStep& step) {
    std::vector<Moments> nodes = step.responses ? combined_nodes(step) : planned(step.nodes());
    if (!step.shapes) return {std::move(nodes), {}};
    const Clock::time_point start = Clock::now();
    std::vector<ShapeBlock> blocks = shape_blocks(step, nodes);
    work_.sums_s += seconds_since(start);
    std::vector<Moments> left = left_moments(step.request, blocks);
    return {std::move(left), std::move(blocks)};
  }

 private:
  std::vector<Moments> planned(const MomentsRequest& request) {
    const std::size_t count = request.wanted_count();
    const Progress plan_progress = [&](std::size_t done, std::size_t all) {
      const std::size_t so_far = done_ + count * done / std::max<std::size_t>(all, 1);
      return !progress_ || progress_(plan_.size() * so_far / std::max<std::size_t>(kernel_moments_, 1), plan_.size());
    };
    std::vector<Moments> moments = evaluated(request, plan_progress);
    done_ += count;
    return moments;
  }

  std::vector<Moments> evaluated(const MomentsRequest& request, const Progress& progress) {
    const EvaluationReport before = evaluator_.report();
    const Clock::time_point start = Clock::now();
    std::vector<Moments> moments = evaluator_.evaluate(request, progress);
    work_.transfer_s += transfer_time(before, evaluator_.report(), seconds_since(start));
    return moments;
  }

  std::vector<Moments> combined_nodes(const MomentsStep& step) {
    std::vector<std::vector<Moments>> passes;
    for (const MomentsRequest& pass : step.responses->passes) passes.push_back(planned(pass));
    std::vector<Moments> others;
    if (step.responses->others) others = planned(*step.responses->others);
    const Clock::time_point start = Clock::now();
    std::vector<Moments> moments = combined(step.nodes(), *step.responses, passes, others);
    work_.sums_s += seconds_since(start);
    return moments;
  }

  /// The moments of wanted pairs that have no block; nothing if all have one.
  std::vector<Moments> left_moments(const MomentsRequest& request, std::span<const ShapeBlock> blocks) {
    std::vector<char> is_left(blocks.size());
    for (std::size_t i = 0; i < blocks.size(); ++i)
      is_left[i] = blocks[i].is_empty() && request.is_wanted(i * request.shapes()) ? 1 : 0;
    if (std::ranges::find(is_left, 1) == is_left.end()) return {};
    MomentsRequest left = request;
    left.basis = nullptr;
    left.wanted.clear();
    for (const char flag : is_left) left.wanted.insert(left.wanted.end(), request.shapes(), flag);
    work_.interpolated -= left.wanted_count();
    return evaluated(left, [&](std::size_t, std::size_t) { return !progress_ || progress_(1, 1); });
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
    : plan_(std::move(plan)), steps_(std::move(steps)), places_(plan_.directions()) {
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const std::vector<std::size_t>& directions = plan_.steps()[i].directions;
    for (std::size_t j = 0; j < directions.size(); ++j) places_[directions[j]] = {i, j};
  }
}

PlannedMoments::Range PlannedMoments::read(std::size_t entry, std::vector<Moments>& buffer) const {
  if (steps_.size() == 1 && steps_.front().blocks.empty()) return {0, steps_.front().moments};
  const std::size_t shapes = plan_.steps().front().request.shapes();
  const std::size_t pair = entry / shapes;
  const Place& place = places_[pair % places_.size()];
  const Step& step = steps_[place.step];
  const MomentsStep& planned = plan_.steps()[place.step];
  const std::size_t own_pair = pair / places_.size() * planned.directions.size() + place.position;
  if (step.blocks.empty() || step.blocks[own_pair].is_empty())
    return {pair * shapes, std::span(step.moments).subspan(own_pair * shapes, shapes)};
  const std::size_t qs = planned.request.q.size(), sigma = entry % shapes / qs, q = entry % qs;
  ShapeRange range{.first_q = q - q % kInterpolatedAtOnce};
  range.qs = std::min(kInterpolatedAtOnce, qs - range.first_q);
  const std::size_t sigmas_at_once = std::max<std::size_t>(kInterpolatedAtOnce / qs, 1);
  range.first_sigma = sigma - sigma % sigmas_at_once;
  range.sigmas = std::min(sigmas_at_once, planned.request.sigma.size() - range.first_sigma);
  buffer.resize(range.sigmas * range.qs);
  interpolate(*planned.shapes, step.blocks[own_pair], range, buffer);
  return {pair * shapes + range.first_sigma * qs + range.first_q, buffer};
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
