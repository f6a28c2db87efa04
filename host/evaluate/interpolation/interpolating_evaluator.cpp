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

/// Fills in the moments of the directions whose nodes are finite. Returns the others.
std::vector<std::size_t> interpolate_all(const ShapePlan& plan, std::span<const Moments> nodes,
                                         const MomentsRequest& request, std::span<Moments> moments) {
  const std::size_t indices = request.indices.size();
  const std::size_t of_direction = plan.nodes_of_a_direction();
  const std::size_t shapes = request.sigma.size() * request.q.size();
  std::vector<char> is_done(request.theta_deg.size(), 0);
  parallel_ranges(is_done.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t theta = first; theta < last; ++theta) {
      if (!std::ranges::all_of(nodes.subspan(theta * indices * of_direction, indices * of_direction), is_finite))
        continue;
      for (std::size_t i = theta * indices; i < (theta + 1) * indices; ++i) {
        interpolate(plan, nodes.subspan(i * of_direction, of_direction), moments.subspan(i * shapes, shapes));
      }
      is_done[theta] = 1;
    }
  });
  std::vector<std::size_t> left;
  for (std::size_t theta = 0; theta < is_done.size(); ++theta) {
    if (is_done[theta] == 0) left.push_back(theta);
  }
  return left;
}

}  // namespace

std::vector<Moments> InterpolatingEvaluator::evaluate(const MomentsRequest& request, const Progress& progress) {
  using Clock = std::chrono::steady_clock;
  const std::optional<ShapePlan> plan = shape_plan(request);
  if (!plan) return evaluator_->evaluate(request, progress);
  const Progress of_nodes = [&](std::size_t done, std::size_t all) {
    return !progress || progress(request.size() * done / all, request.size());
  };
  const std::vector<Moments> nodes = evaluator_->evaluate(plan->nodes, of_nodes);
  const Clock::time_point start = Clock::now();
  std::vector<Moments> moments(request.size());
  const std::vector<std::size_t> left = interpolate_all(*plan, nodes, request, moments);
  interpolation_s_ += seconds_since(start);
  nodes_ += nodes.size();
  const std::size_t of_theta = request.size() / request.theta_deg.size();
  interpolated_ += request.size() - left.size() * of_theta;
  if (left.empty()) return moments;
  MomentsRequest direct = request;
  direct.may_interpolate = false;
  direct.theta_deg.clear();
  for (const std::size_t theta : left) direct.theta_deg.push_back(request.theta_deg[theta]);
  const Progress is_wanted = [&](std::size_t, std::size_t) { return !progress || progress(1, 1); };
  const std::vector<Moments> computed = evaluator_->evaluate(direct, is_wanted);
  for (std::size_t i = 0; i < left.size(); ++i) {
    std::copy_n(computed.begin() + static_cast<std::ptrdiff_t>(i * of_theta), of_theta,
                moments.begin() + static_cast<std::ptrdiff_t>(left[i] * of_theta));
  }
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
