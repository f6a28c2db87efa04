#include "calibrate/rule_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "base/numbers.hpp"
#include "base/parallel_ranges.hpp"
#include "calibrate/random_entries.hpp"
#include "evaluate/kernel/cpu_kernel.hpp"
#include "evaluate/kernel/slope_samples.hpp"
#include "plan/kernel_data.hpp"

namespace dolp {
namespace {

constexpr std::array kTolerances = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8};
constexpr double kCornerShare = 0.25;
// Weight of the evaluations when an entry is computed again, because it missed its tolerance. The evaluations of the
// first computation have the weight 1. For separate points the ideal weight is 1, because a run computes every point.
// For a dense grid it is 30: a run first computes only one entry in 30 and interpolates the others. Then it computes
// every entry that misses its tolerance. 8 is a compromise.
constexpr double kAgainWeight = 8.0;
// The reflected light has the DOLP r_q / r_i. The error of this DOLP is at most (error of r_q + error of r_i) / r_i, so
// at most 2 * (larger error) / r_i.
constexpr double kErrorsOfDolp = 2.0;
constexpr int kMostLevels = 8;
constexpr double kLeastTolerance = 1e-13;

MomentsRequest random_request(MomentsRequest request, const RuleFitOptions& options) {
  Draws draw(options.seed);
  for (std::size_t i = 0; i < options.entries; ++i) {
    const Domain domain = draw.chance(kCornerShare) ? Domain::kCorners : Domain::kOrdinary;
    request.append(random_entry(draw, domain, request.distribution, request.masking));
  }
  return request;
}

std::vector<Moments> computed(const MomentsRequest& request, const RuleModel& model) {
  const KernelData data = kernel_data(request, model);
  const std::unique_ptr<CpuKernel> kernel = make_cpu_kernel_double(data);
  const SlopeSampling sampling(data);
  std::vector<Moments> moments(request.size());
  std::vector<std::uint32_t> shapes(data.shapes.size());
  std::iota(shapes.begin(), shapes.end(), 0U);
  if (data.needs_masking_table()) kernel->build_masking_tables(std::move(shapes));
  const auto one = [&](std::size_t i) {
    if (has_slope_samples(request)) {
      sampling.compute(i, *kernel, kDoubleRoundoff, moments);
      return;
    }
    const MomentsEntry entry = data.entry(i, data.bundle_shapes(i).front());
    moments[i] = moments_from_kernel(kernel->moments(entry, {}), data, entry, kDoubleRoundoff);
  };
  parallel_for(moments.size(), 64, one);
  return moments;
}

/// Sum of ln(work) over all entries. The work of an entry is its number of evaluations. While the error of an entry's
/// DOLP is above `tolerance`, the entry is computed again with a smaller tolerance. Each evaluation then counts
/// kAgainWeight times.
double log_work(const MomentsRequest& all, double tolerance, const RuleModel& model) {
  std::vector<double> work(all.size(), 0.0);
  std::vector<std::uint32_t> wanted(all.size());
  for (std::uint32_t i = 0; i < wanted.size(); ++i) wanted[i] = i;
  MomentsRequest request = all;
  request.tolerance = tolerance;
  for (int level = 0; level < kMostLevels && !wanted.empty(); ++level) {
    request = request.without_entries();
    for (const std::uint32_t i : wanted) request.append(all[i]);
    const std::vector<Moments> moments = computed(request, model);
    std::vector<std::uint32_t> again;
    for (std::size_t j = 0; j < wanted.size(); ++j) {
      work[wanted[j]] += (level == 0 ? 1.0 : kAgainWeight) * moments[j].evaluations;
      const double error = kErrorsOfDolp * std::max(moments[j].r_i_error, moments[j].r_q_error);
      if (!(error <= tolerance * std::abs(moments[j].r_i))) again.push_back(wanted[j]);
    }
    wanted = again;
    request.tolerance = std::max(request.tolerance * std::sqrt(0.1), kLeastTolerance);
  }
  double sum = 0.0;
  for (const double of_entry : work) sum += std::log(of_entry);
  return sum;
}

/// A constant of the rules, and the amount by which the search first changes it.
struct Parameter {
  double RuleModel::*value;
  double step;
};

std::vector<Parameter> parameters(Masking masking) {
  std::vector<Parameter> all = {{&RuleModel::margin_digits, 0.4}, {&RuleModel::t_nodes, 0.4},
                                {&RuleModel::t_digits, 0.5},      {&RuleModel::t_fall, 0.06},
                                {&RuleModel::phi_nodes, 0.1},     {&RuleModel::phi_digits, 0.5}};
  if (masking == Masking::kSmith) all.push_back({&RuleModel::cluster_stretch, 1.0});
  return all;
}

}  // namespace

double mean_log_work(const MomentsRequest& integrand, const RuleModel& model, const RuleFitOptions& options) {
  double sum = 0.0;
  for (const Distribution distribution : {Distribution::kCauchy, Distribution::kGaussian}) {
    MomentsRequest request = integrand;
    request.distribution = distribution;
    request = random_request(request, options);
    for (const double tolerance : kTolerances) sum += log_work(request, tolerance, model);
  }
  return sum / static_cast<double>(2 * kTolerances.size() * options.entries);
}

RuleModel fit_rule(const MomentsRequest& integrand, const RuleFitOptions& options,
                   const std::function<void(const RuleModel&, double)>& note) {
  RuleModel best = kFitStart;
  double least = mean_log_work(integrand, best, options);
  note(best, least);
  double width = 1.0;
  for (int round = 0; round < options.rounds; ++round, width *= 0.5) {
    for (const Parameter& parameter : parameters(integrand.masking)) {
      for (const double direction : {1.0, -1.0}) {
        const double before = least;
        for (bool gains = true; gains;) {
          RuleModel candidate = best;
          candidate.*parameter.value += direction * width * parameter.step;
          const double work = mean_log_work(integrand, candidate, options);
          gains = work < least;
          if (!gains) break;
          best = candidate;
          least = work;
          note(best, least);
        }
        if (least < before) break;  // steps in this direction helped, so steps in the opposite direction would not
      }
    }
  }
  return best;
}

std::string rule_text(const RuleModel& model) {
  return fmt::format(
      "{{.margin_digits = {:.3g}, .t_nodes = {:.3g}, .t_digits = {:.3g}, .t_fall = {:.3g}, "
      ".phi_nodes = {:.3g}, .phi_digits = {:.3g}, .cluster_stretch = {:.3g}}}",
      model.margin_digits, model.t_nodes, model.t_digits, model.t_fall, model.phi_nodes, model.phi_digits,
      model.cluster_stretch);
}

}  // namespace dolp
