#include "evaluate/interpolation/interpolating_evaluator.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>

#include "base/parallel_ranges.hpp"
#include "base/stopwatch.hpp"
#include "model/angles.hpp"
#include "plan/response_plan.hpp"
#include "plan/shape_plan.hpp"

namespace dolp {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kColumnsAtOnce = 1U << 20U;  // of a pass, for the memory that they take

bool is_finite(const Moments& m) {
  return std::isfinite(m.r_i + m.r_q + m.albedo + m.deficit) &&
         std::isfinite(m.r_i_error + m.r_q_error + m.albedo_error + m.deficit_error);
}

/// Fills in the moments of each direction and index whose nodes are finite. Returns 1 for
/// each other wanted pair of direction and index, else 0.
std::vector<char> interpolate_all(const ShapePlan& plan, std::span<const Moments> nodes, const MomentsRequest& request,
                                  std::span<Moments> moments) {
  const std::size_t of_nodes = plan.nodes_of_a_direction();
  const std::size_t shapes = request.sigma.size() * request.q.size();
  std::vector<char> is_left(request.size() / shapes, 0);
  parallel_ranges(is_left.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (!request.is_wanted(i * shapes)) continue;
      const std::span<const Moments> own = nodes.subspan(i * of_nodes, of_nodes);
      is_left[i] = std::ranges::all_of(own, is_finite) ? 0 : 1;
      if (is_left[i] == 0) interpolate(plan, own, moments.subspan(i * shapes, shapes));
    }
  });
  return is_left;
}

}  // namespace

std::vector<Moments> InterpolatingEvaluator::computed(const MomentsRequest& request, const Progress& progress) {
  if (!request.basis || request.size() == 0) return evaluator_->evaluate(request, progress);
  std::vector<std::size_t> directions(request.theta_deg.size());
  std::iota(directions.begin(), directions.end(), std::size_t{0});
  const std::size_t columns = request.basis->count() * request.sigma.size() * request.q.size();
  const std::size_t at_once = std::max<std::size_t>(1, kColumnsAtOnce / columns);
  std::vector<Moments> moments;
  moments.reserve(request.size());
  for (std::size_t first = 0; first < directions.size(); first += at_once) {
    const std::size_t count = std::min(at_once, directions.size() - first);
    const MomentsRequest part = request.of_directions(std::span(directions).subspan(first, count));
    const Progress of_part = [&](std::size_t done, std::size_t all) {
      return !progress || progress(moments.size() + part.size() * done / std::max<std::size_t>(all, 1), request.size());
    };
    std::ranges::move(combined_from_responses(part, of_part), std::back_inserter(moments));
  }
  return moments;
}

std::vector<Moments> InterpolatingEvaluator::combined_from_responses(const MomentsRequest& request,
                                                                     const Progress& progress) {
  const ResponsePlan plan = response_plan(request);
  const std::size_t wanted = std::max<std::size_t>(plan.wanted_count(), 1);
  nodes_ += wanted;
  std::size_t before = 0;
  const auto evaluated = [&](const MomentsRequest& one) {
    const std::size_t of_one = one.wanted_count();
    const Progress of_all = [&](std::size_t done, std::size_t all) {
      return progress(before + of_one * done / std::max<std::size_t>(all, 1), wanted);
    };
    std::vector<Moments> moments = evaluator_->evaluate(one, of_all);
    before += of_one;
    return moments;
  };
  std::vector<std::vector<Moments>> passes;
  for (const MomentsRequest& pass : plan.passes) passes.push_back(evaluated(pass));
  std::vector<Moments> others;
  if (plan.others) others = evaluated(*plan.others);
  const Clock::time_point start = Clock::now();
  std::vector<Moments> moments = combined(request, plan, passes, others);
  interpolation_s_ += seconds_since(start);
  return moments;
}

std::vector<Moments> InterpolatingEvaluator::evaluate(const MomentsRequest& request, const Progress& progress) {
  const std::vector<MomentsRequest> parts = with_one_parameter(request);
  if (parts.size() == 1) return evaluate_part(request, progress);
  std::vector<std::vector<Moments>> of_parts;
  std::size_t before = 0;
  for (const MomentsRequest& part : parts) {
    const Progress of_part = [&](std::size_t done, std::size_t all) {
      return !progress || progress(before + part.size() * done / all, request.size());
    };
    of_parts.push_back(evaluate_part(part, of_part));
    before += part.size();
  }
  std::vector<Moments> moments;
  moments.reserve(request.size());
  const std::size_t of_theta = request.size() / request.theta_deg.size();
  std::vector<std::size_t> next(parts.size(), 0);
  for (const double theta_deg : request.theta_deg) {
    std::size_t part = 0;
    while (next[part] == parts[part].theta_deg.size() || parts[part].theta_deg[next[part]] != theta_deg) ++part;
    const auto first = of_parts[part].begin() + static_cast<std::ptrdiff_t>(next[part]++ * of_theta);
    moments.insert(moments.end(), first, first + static_cast<std::ptrdiff_t>(of_theta));
  }
  return moments;
}

std::vector<Moments> InterpolatingEvaluator::evaluate_part(const MomentsRequest& request, const Progress& progress) {
  const std::optional<ShapePlan> plan = shape_plan(request);
  if (plan || request.basis) interpolated_ += request.wanted_count();
  if (!plan) return computed(request, progress);
  const Progress of_nodes = [&](std::size_t done, std::size_t all) {
    return !progress || progress(request.size() * done / all, request.size());
  };
  const std::vector<Moments> nodes = computed(plan->nodes, of_nodes);
  const Clock::time_point start = Clock::now();
  std::vector<Moments> moments(request.size());
  const std::vector<char> is_left = interpolate_all(*plan, nodes, request, moments);
  interpolation_s_ += seconds_since(start);
  if (!request.basis) nodes_ += plan->nodes.wanted_count();
  if (std::ranges::find(is_left, 1) == is_left.end()) return moments;
  const std::size_t of_theta = request.size() / request.theta_deg.size();
  const std::size_t shapes = of_theta / request.indices.size();
  MomentsRequest direct = request;
  direct.may_interpolate = false;
  direct.theta_deg.clear();
  direct.wanted.clear();
  std::vector<std::size_t> places;  // of the direct request's directions
  for (std::size_t theta = 0; theta < request.theta_deg.size(); ++theta) {
    const auto of_indices = std::span(is_left).subspan(theta * request.indices.size(), request.indices.size());
    if (std::ranges::find(of_indices, 1) == of_indices.end()) continue;
    direct.theta_deg.push_back(request.theta_deg[theta]);
    places.push_back(theta * of_theta);
    for (const char left : of_indices) direct.wanted.insert(direct.wanted.end(), shapes, left);
  }
  interpolated_ -= direct.wanted_count();
  const Progress is_wanted = [&](std::size_t, std::size_t) { return !progress || progress(1, 1); };
  const std::vector<Moments> computed = evaluator_->evaluate(direct, is_wanted);
  for (std::size_t i = 0; i < computed.size(); ++i) {
    if (direct.wanted[i] != 0) moments[places[i / of_theta] + i % of_theta] = computed[i];
  }
  return moments;
}

void InterpolatingEvaluator::clear_report() {
  evaluator_->clear_report();
  interpolated_ = nodes_ = 0;
  interpolation_s_ = 0.0;
}

std::vector<char> InterpolatingEvaluator::interpolated_directions(const MomentsRequest& request) const {
  return dolp::interpolated_directions(request);
}

EvaluationReport InterpolatingEvaluator::report() const {
  EvaluationReport report = evaluator_->report();
  report.interpolated = interpolated_;
  report.interpolation_nodes = nodes_;
  report.sums_s += interpolation_s_;
  return report;
}

}  // namespace dolp
