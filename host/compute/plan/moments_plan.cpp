#include "plan/moments_plan.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace dolp {
namespace {

constexpr std::size_t kColumnsAtOnce = 1U << 20U;  // largest number of columns in a step; limits its memory

template <class List, class CountOf>
std::size_t sum_over(const List& list, const CountOf& item_count) {
  std::size_t sum = 0;
  for (const auto& item : list) sum += item_count(item);
  return sum;
}

std::size_t kernel_moment_count(const MomentsStep& step) {
  return sum_over(step.kernel_requests(), [](const MomentsRequest* request) { return request->wanted_count(); });
}

}  // namespace

std::vector<const MomentsRequest*> MomentsStep::kernel_requests() const {
  if (!responses) return {&nodes()};
  std::vector<const MomentsRequest*> requests;
  for (const MomentsRequest& pass : responses->passes) requests.push_back(&pass);
  if (responses->others) requests.push_back(&*responses->others);
  return requests;
}

MomentsPlan::MomentsPlan(const MomentsRequest& request) : size_(request.size()) {
  if (size_ == 0) return;
  if (request.layout == MomentsRequest::Layout::kList) {
    MomentsStep& step = steps_.emplace_back();
    step.request = request;
    if (request.basis) step.responses = response_plan(request);
    return;
  }
  directions_ = request.theta_deg.size();
  for (std::vector<std::size_t>& directions : split_grazing_directions(request)) {
    MomentsStep step{.directions = std::move(directions)};
    step.request = request.select_directions(step.directions);
    step.shapes = shape_plan(step.request);
    add(std::move(step));
  }
}

void MomentsPlan::add(MomentsStep step) {
  const MomentsRequest& nodes = step.nodes();
  if (!nodes.basis) {
    steps_.push_back(std::move(step));
    return;
  }
  const ResponsePlan responses = *response_plan(nodes);
  const std::size_t columns = nodes.basis->count() * nodes.sigma.size() * nodes.q.size();
  const std::size_t at_once = std::max<std::size_t>(1, kColumnsAtOnce / columns);
  for (std::size_t first = 0; first < step.directions.size(); first += at_once) {
    std::vector<std::size_t> positions(std::min(at_once, step.directions.size() - first));
    std::iota(positions.begin(), positions.end(), first);
    MomentsStep& part = steps_.emplace_back();
    for (const std::size_t i : positions) part.directions.push_back(step.directions[i]);
    part.request = step.request.select_directions(positions);
    part.shapes = step.shapes;
    if (part.shapes) part.shapes->nodes = step.shapes->nodes.select_directions(positions);
    part.responses = responses.select_directions(positions);
  }
}

std::size_t MomentsPlan::saved_entries() const {
  return sum_over(steps_, [](const MomentsStep& step) { return step.saves_work() ? step.request.wanted_count() : 0; });
}

std::size_t MomentsPlan::nodes_of_saved() const {
  return sum_over(steps_, [](const MomentsStep& step) { return step.saves_work() ? kernel_moment_count(step) : 0; });
}

std::size_t MomentsPlan::kernel_moments() const { return sum_over(steps_, kernel_moment_count); }

std::vector<char> MomentsPlan::saving_directions() const {
  std::vector<char> saves(directions_, 0);
  for (const MomentsStep& step : steps_) {
    for (const std::size_t direction : step.directions) saves[direction] = step.saves_work() ? 1 : 0;
  }
  return saves;
}

}  // namespace dolp
