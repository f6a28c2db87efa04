// The evaluators of dolp as methods of the benchmark.
#include <algorithm>
#include <dolp/errors.hpp>

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "evaluate/planned_moments.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "methods/method.hpp"

namespace dolp::bench {
namespace {

class EvaluatorSolver final : public Solver {
 public:
  EvaluatorSolver(std::unique_ptr<ModelEvaluator> evaluator, Precision precision)
      : precision_(precision), evaluator_(std::move(evaluator)) {}

  Solution solve(const MomentsRequest& request, double setting) override {
    MomentsRequest wanted = request;
    wanted.tolerance = setting;
    wanted.precision = precision_;
    wanted.may_interpolate = false;
    const EvaluationReport before = evaluator_->report();
    Work host_work;
    const PlannedMoments moments = planned_moments(MomentsPlan(wanted), *evaluator_, nullptr, host_work);
    const EvaluationReport after = evaluator_->report();
    Solution solution;
    solution.kernel_s = after.kernel_s + after.sums_s + host_work.sums_s - (before.kernel_s + before.sums_s);
    solution.evaluations = after.evaluations - before.evaluations;
    for (const Moments& entry : moments.all()) {
      solution.answers.push_back({entry.r_i, entry.r_q, std::max(entry.r_i_error, entry.r_q_error) / entry.r_i});
    }
    return solution;
  }

  std::string where() const override {
    const EvaluationReport report = evaluator_->report();
    return report.driver.empty() ? report.device : report.device + ", " + report.driver;
  }

 private:
  Precision precision_;
  std::unique_ptr<ModelEvaluator> evaluator_;
};

std::unique_ptr<ModelEvaluator> vulkan_evaluator(const SolverOptions& options, Precision precision) {
  VulkanOptions vulkan;
  vulkan.device = options.device;
  vulkan.needs_double = precision == Precision::kDouble;
  try {
    return std::make_unique<VulkanEvaluator>(vulkan);
  } catch (const DeviceError& error) {
    throw Unavailable(error.what());
  }
}

}  // namespace

std::unique_ptr<Solver> make_vulkan(const SolverOptions& options, Precision precision) {
  return std::make_unique<EvaluatorSolver>(vulkan_evaluator(options, precision), precision);
}

std::unique_ptr<Solver> make_cpu(Precision precision) {
  return std::make_unique<EvaluatorSolver>(std::make_unique<CpuEvaluator>(), precision);
}

}  // namespace dolp::bench
