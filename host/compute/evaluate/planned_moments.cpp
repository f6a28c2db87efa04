#include "evaluate/planned_moments.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>
#include <utility>

#include "base/parallel_ranges.hpp"
#include "base/stopwatch.hpp"

namespace dolp {
namespace {

using Clock = std::chrono::steady_clock;

bool is_finite(const Moments& m) {
  return std::isfinite(m.r_i + m.r_q + m.albedo + m.deficit) &&
         std::isfinite(m.r_i_error + m.r_q_error + m.albedo_error + m.deficit_error);
}

/// Interpolates over the slope distributions, for each wanted pair of a direction and an index. `nodes` has the known
/// moments. A pair with infinite or NaN known moments is left out. Returns a flag per entry: 1 if its pair is left out.
std::vector<char> interpolate_all(const ShapePlan& plan, std::span<const Moments> nodes, const MomentsRequest& request,
                                  std::span<Moments> moments) {
  const std::size_t nodes_per_pair = plan.nodes_of_a_direction();
  const std::size_t shapes = request.shapes();
  std::vector<char> is_left(request.size(), 0);
  parallel_ranges(request.size() / shapes, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (!request.is_wanted(i * shapes)) continue;
      const std::span<const Moments> pair_nodes = nodes.subspan(i * nodes_per_pair, nodes_per_pair);
      if (std::ranges::all_of(pair_nodes, is_finite)) {
        interpolate(plan, pair_nodes, moments.subspan(i * shapes, shapes));
      } else {
        std::ranges::fill(std::span(is_left).subspan(i * shapes, shapes), char{1});
      }
    }
  });
  return is_left;
}

class PlannedMoments {
 public:
  PlannedMoments(const MomentsPlan& plan, ModelEvaluator& evaluator, const Progress& progress, Work& work)
      : plan_(plan), evaluator_(evaluator), progress_(progress), work_(work), kernel_moments_(plan.kernel_moments()) {
    work_.interpolated += plan.saved_entries();
    work_.interpolation_nodes += plan.nodes_of_saved();
  }

  std::vector<Moments> all() {
    const std::span<const MomentsStep> steps = plan_.steps();
    if (steps.size() == 1) return evaluate_step(steps.front());
    std::vector<Moments> moments(plan_.size());
    for (const MomentsStep& step : steps) {
      std::vector<Moments> step_moments = evaluate_step(step);
      const std::size_t shapes = step.request.shapes();
      const std::size_t directions = plan_.directions();
      for (std::size_t i = 0; i < step_moments.size(); ++i) {
        const std::size_t pair = i / shapes;
        const std::size_t index = pair / step.directions.size();
        const std::size_t direction = step.directions[pair % step.directions.size()];
        moments[(index * directions + direction) * shapes + i % shapes] = std::move(step_moments[i]);
      }
    }
    return moments;
  }

 private:
  std::vector<Moments> from_kernel(const MomentsRequest& request) {
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

  std::vector<Moments> evaluate_nodes(const MomentsStep& step) {
    if (!step.responses) return from_kernel(step.nodes());
    std::vector<std::vector<Moments>> passes;
    for (const MomentsRequest& pass : step.responses->passes) passes.push_back(from_kernel(pass));
    std::vector<Moments> others;
    if (step.responses->others) others = from_kernel(*step.responses->others);
    const Clock::time_point start = Clock::now();
    std::vector<Moments> moments = combined(step.nodes(), *step.responses, passes, others);
    work_.sums_s += seconds_since(start);
    return moments;
  }

  std::vector<Moments> evaluate_step(const MomentsStep& step) {
    std::vector<Moments> nodes = evaluate_nodes(step);
    if (!step.shapes) return nodes;
    const Clock::time_point start = Clock::now();
    std::vector<Moments> moments(step.request.size());
    std::vector<char> is_left = interpolate_all(*step.shapes, nodes, step.request, moments);
    work_.sums_s += seconds_since(start);
    if (std::ranges::find(is_left, 1) != is_left.end()) compute_left(step.request, std::move(is_left), moments);
    return moments;
  }

  void compute_left(const MomentsRequest& request, std::vector<char> is_left, std::span<Moments> moments) {
    MomentsRequest direct = request;
    direct.basis = nullptr;
    direct.wanted = std::move(is_left);
    work_.interpolated -= direct.wanted_count();
    const Progress is_wanted = [&](std::size_t, std::size_t) { return !progress_ || progress_(1, 1); };
    const std::vector<Moments> computed = evaluated(direct, is_wanted);
    for (std::size_t i = 0; i < computed.size(); ++i) {
      if (direct.wanted[i] != 0) moments[i] = computed[i];
    }
  }

  const MomentsPlan& plan_;
  ModelEvaluator& evaluator_;
  const Progress& progress_;
  Work& work_;
  std::size_t kernel_moments_;
  std::size_t done_ = 0;
};

}  // namespace

std::vector<Moments> planned_moments(const MomentsPlan& plan, ModelEvaluator& evaluator, const Progress& progress,
                                     Work& work) {
  return plan.size() == 0 ? std::vector<Moments>{} : PlannedMoments(plan, evaluator, progress, work).all();
}

}  // namespace dolp
