#include "plan/moments_plan.hpp"

#include <algorithm>
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
  return sum_over(step.kernel_requests(), [](const MomentsRequest* request) { return request->size(); });
}

/// Divides bundles into `parts`, so that bundles of one direction are in one part.
std::vector<std::vector<std::size_t>> split_directions(const MomentsRequest& request, std::size_t parts) {
  std::vector<std::vector<std::size_t>> split(parts);
  for (std::size_t i = 0; i < request.bundles.size(); ++i)
    split[request.bundles[i].direction * parts / request.theta_deg.size()].push_back(i);
  std::erase_if(split, [](const std::vector<std::size_t>& part) { return part.empty(); });
  return split;
}

}  // namespace

std::vector<const MomentsRequest*> MomentsStep::kernel_requests() const {
  if (!responses) return {&nodes()};
  std::vector<const MomentsRequest*> requests;
  for (const MomentsRequest& pass : responses->passes) requests.push_back(&pass);
  if (responses->others) requests.push_back(&*responses->others);
  return requests;
}

MomentsPlan::MomentsPlan(const MomentsRequest& request) : size_(request.size()), bundles_(request.bundles.size()) {
  std::vector<char> is_left(bundles_, 1);
  for (std::vector<std::size_t>& bundles : interpolation_groups(request)) {
    MomentsStep step{.bundles = std::move(bundles)};
    step.request = request.select_bundles(step.bundles);
    step.shapes = shape_plan(step.request);
    if (!step.shapes) continue;
    for (const std::size_t bundle : step.bundles) is_left[bundle] = 0;
    add(std::move(step));
  }
  MomentsStep rest;
  for (std::size_t i = 0; i < bundles_; ++i) {
    if (is_left[i] != 0) rest.bundles.push_back(i);
  }
  if (rest.bundles.empty()) return;
  rest.request = rest.bundles.size() == bundles_ ? request : request.select_bundles(rest.bundles);
  add(std::move(rest));
}

void MomentsPlan::add(MomentsStep step) {
  const MomentsRequest& nodes = step.nodes();
  if (nodes.basis) step.responses = response_plan(nodes);
  const bool has_passes = step.responses && !step.responses->passes.empty();
  const std::size_t columns = has_passes ? step.responses->passes.front().size() * nodes.basis->count() : 0;
  if (columns <= kColumnsAtOnce) {
    steps_.push_back(std::move(step));
    return;
  }
  for (const std::vector<std::size_t>& positions : split_directions(nodes, columns / kColumnsAtOnce + 1)) {
    MomentsStep& part = steps_.emplace_back();
    for (const std::size_t i : positions) part.bundles.push_back(step.bundles[i]);
    part.request = step.request.select_bundles(positions);
    part.shapes = step.shapes;
    if (part.shapes) part.shapes->nodes = step.shapes->nodes.select_bundles(positions);
    part.responses = response_plan(part.nodes(), step.responses->sources);
  }
}

std::size_t MomentsPlan::saved_entries() const {
  return sum_over(steps_, [](const MomentsStep& step) { return step.saves_work() ? step.request.size() : 0; });
}

std::size_t MomentsPlan::nodes_of_saved() const {
  return sum_over(steps_, [](const MomentsStep& step) { return step.saves_work() ? kernel_moment_count(step) : 0; });
}

std::size_t MomentsPlan::kernel_moments() const { return sum_over(steps_, kernel_moment_count); }

std::vector<char> MomentsPlan::saving_bundles() const {
  std::vector<char> saves(bundles_, 0);
  for (const MomentsStep& step : steps_) {
    for (const std::size_t bundle : step.bundles) saves[bundle] = step.saves_work() ? 1 : 0;
  }
  return saves;
}

}  // namespace dolp
