#include "evaluate/interpolation/interpolating_evaluator.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <span>

#include "base/parallel_ranges.hpp"
#include "base/stopwatch.hpp"
#include "plan/shape_plan.hpp"

namespace dolp {
namespace {

bool is_finite(const Moments& m) {
  return std::isfinite(m.r_i + m.r_q + m.albedo + m.deficit) &&
         std::isfinite(m.r_i_error + m.r_q_error + m.albedo_error + m.deficit_error);
}

/// Progress of a part of the work, in units of `total` entries: `before` of `all` computed moments are done.
Progress part_of(const Progress& progress, std::size_t before, std::size_t all, std::size_t total) {
  if (!progress) return {};
  return [&progress, before, all, total](std::size_t done, std::size_t) {
    return progress(total * (before + done) / all, total);
  };
}

/// Fills in the moments of the slabs whose nodes are finite; the entries of the others join plan.direct.
void interpolate(ShapePlan& plan, const MomentsRequest& request, std::span<const Moments> nodes,
                 std::span<Moments> moments) {
  std::vector<char> is_done(plan.slabs.size(), 0);
  parallel_ranges(plan.slabs.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t s = first; s < last; ++s) {
      const std::span<const Moments> of_slab = nodes.subspan(s * plan.nodes_of_a_slab(), plan.nodes_of_a_slab());
      if (!std::ranges::all_of(of_slab, is_finite)) continue;
      const std::vector<Moments> results = interpolated(plan, plan.slabs[s], request, of_slab);
      for (std::size_t i = 0; i < results.size(); ++i) moments[plan.slabs[s].entries[i]] = results[i];
      is_done[s] = 1;
    }
  });
  for (std::size_t s = 0; s < plan.slabs.size(); ++s) {
    if (is_done[s] != 0) continue;
    for (const std::uint32_t i : plan.slabs[s].entries) {
      plan.direct_entries.push_back(i);
      plan.direct.entries.push_back(request.entries[i]);
    }
  }
}

}  // namespace

std::vector<Moments> InterpolatingEvaluator::evaluate(const MomentsRequest& request, const Progress& progress) {
  using Clock = std::chrono::steady_clock;
  std::optional<ShapePlan> plan = shape_plan(request);
  if (!plan) return evaluator_->evaluate(request, progress);
  const std::size_t total = request.entries.size();
  const std::size_t node_count = plan->nodes.entries.size();
  const std::size_t planned = node_count + plan->direct.entries.size();
  const std::vector<Moments> nodes = evaluator_->evaluate(plan->nodes, part_of(progress, 0, planned, total));
  std::vector<Moments> moments(total);
  const Clock::time_point start = Clock::now();
  interpolate(*plan, request, nodes, moments);
  interpolation_s_ += seconds_since(start);
  nodes_ += node_count;
  interpolated_ += total - plan->direct.entries.size();
  if (plan->direct.entries.empty()) return moments;
  const std::size_t all = node_count + plan->direct.entries.size();
  const std::vector<Moments> direct = evaluator_->evaluate(plan->direct, part_of(progress, node_count, all, total));
  for (std::size_t i = 0; i < direct.size(); ++i) moments[plan->direct_entries[i]] = direct[i];
  return moments;
}

EvaluationReport InterpolatingEvaluator::report() const {
  EvaluationReport report = evaluator_->report();
  report.interpolated = interpolated_;
  report.interpolation_nodes = nodes_;
  report.kernel_s += interpolation_s_;
  return report;
}

}  // namespace dolp
