#include "plan/index_plan.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "plan/constants.hpp"

namespace dolp {
namespace {

/// Flags of the wanted entries of the nodes; a basis node is wanted where any index combined from the basis is wanted.
std::vector<char> wanted_of_nodes(const MomentsRequest& request, const IndexPlan& plan) {
  const std::size_t shapes = request.sigma.size() * request.q.size();
  const std::size_t of_basis = request.basis->indices().size();
  std::vector<char> wanted(plan.nodes.size(), 0);
  for (std::size_t theta = 0; theta < request.theta_deg.size(); ++theta) {
    for (std::size_t i = 0; i < plan.sources.size(); ++i) {
      const IndexPlan::Source& source = plan.sources[i];
      const std::size_t first = source.weights ? 0 : source.node;
      const std::size_t last = source.weights ? of_basis : source.node + 1;
      for (std::size_t shape = 0; shape < shapes; ++shape) {
        if (!request.is_wanted((theta * plan.sources.size() + i) * shapes + shape)) continue;
        for (std::size_t node = first; node < last; ++node)
          wanted[(theta * plan.nodes.indices.size() + node) * shapes + shape] = 1;
      }
    }
  }
  return wanted;
}

}  // namespace

IndexPlan index_plan(const MomentsRequest& request) {
  const IndexBasis& basis = *request.basis;
  IndexPlan plan;
  plan.nodes = request;
  plan.nodes.basis = nullptr;
  plan.nodes.tolerance = request.finer_tolerance(kIndexNodeTolerance);
  plan.nodes.indices = basis.indices();
  for (const OpticalConstants& index : request.indices) {
    IndexPlan::Source& source = plan.sources.emplace_back();
    source.weights = basis.weights_of(index);
    if (source.weights) continue;
    source.node = plan.nodes.indices.size();
    plan.nodes.indices.push_back(index);
  }
  if (!request.wanted.empty()) plan.nodes.wanted = wanted_of_nodes(request, plan);
  return plan;
}

void combine(const IndexPlan& plan, const IndexPlan::Source& source, double cosine, std::span<const Moments> nodes,
             std::span<Moments> moments) {
  const std::size_t shapes = moments.size();
  if (!source.weights) {
    std::ranges::copy(nodes.subspan(source.node * shapes, shapes), moments.begin());
    return;
  }
  const auto& [mean, difference, mean_error, difference_error] = *source.weights;
  const double evaluations_share = 1.0 / static_cast<double>(plan.sources.size());
  for (std::size_t shape = 0; shape < shapes; ++shape) {
    // The albedo is the same for every index.
    Moments sum;
    sum.albedo = nodes[shape].albedo;
    sum.albedo_error = nodes[shape].albedo_error;
    sum.r_i_error = sum.deficit_error = mean_error * (sum.albedo + sum.albedo_error);
    sum.r_q_error = difference_error * (sum.albedo + sum.albedo_error);
    sum.direct_i = sum.direct_q = 0.0;
    sum.sky.assign(nodes[shape].sky.size(),
                   {.error = std::max(mean_error, difference_error) * (sum.albedo + sum.albedo_error)});
    sum.direct_i_error = mean_error * cosine;
    sum.direct_q_error = difference_error * cosine;
    for (Eigen::Index i = 0; i < mean.size(); ++i) {
      const Moments& node = nodes[static_cast<std::size_t>(i) * shapes + shape];
      sum.r_i += mean[i] * node.r_i;
      sum.r_q += difference[i] * node.r_q;
      sum.deficit += mean[i] * node.deficit;
      sum.direct_i += mean[i] * node.direct_i;
      sum.direct_q += difference[i] * node.direct_q;
      for (std::size_t k = 0; k < node.sky.size(); ++k) {
        sum.sky[k].i += mean[i] * node.sky[k].i;
        sum.sky[k].q += difference[i] * node.sky[k].q;
        sum.sky[k].error += std::max(std::abs(mean[i]), std::abs(difference[i])) * node.sky[k].error;
      }
      sum.r_i_error += std::abs(mean[i]) * node.r_i_error;
      sum.r_q_error += std::abs(difference[i]) * node.r_q_error;
      sum.deficit_error += std::abs(mean[i]) * node.deficit_error;
      sum.direct_i_error += std::abs(mean[i]) * node.direct_i_error;
      sum.direct_q_error += std::abs(difference[i]) * node.direct_q_error;
      sum.evaluations += evaluations_share * node.evaluations;
    }
    moments[shape] = sum;
  }
}

}  // namespace dolp
