#include "methods/truth.hpp"

#include <algorithm>
#include <cmath>

#include "reference/reference_evaluator.hpp"

namespace dolp::bench {
namespace {

constexpr double kReferenceTolerance = 1e-13;

}  // namespace

std::vector<Truth> truths_of(MomentsRequest request) {
  request.tolerance = 0.0;
  ReferenceEvaluator reference({.relative_tolerance = kReferenceTolerance});
  std::vector<Truth> truths;
  for (const Moments& moments : reference.evaluate(request, nullptr)) {
    truths.push_back({moments, std::max(moments.r_i_error, moments.r_q_error) / moments.r_i, 0.0});
  }
  const double time_s = reference.report().kernel_s / static_cast<double>(std::max<std::size_t>(truths.size(), 1));
  for (Truth& truth : truths) truth.time_s = time_s;
  return truths;
}

double error_of(const Answer& answer, const Truth& truth) {
  return std::max(std::abs(answer.r_i - truth.moments.r_i), std::abs(answer.r_q - truth.moments.r_q)) /
         truth.moments.r_i;
}

}  // namespace dolp::bench
