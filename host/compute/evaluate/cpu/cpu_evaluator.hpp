// Moments and pBRDFs on all cores of the CPU, from the kernel source.
#pragma once

#include "model/evaluator.hpp"
#include "model/moments.hpp"
#include "model/scattering.hpp"

namespace dolp {

/// Evaluator "cpu": kernel and rules of the Vulkan evaluator, compiled by the C++ compiler.
class CpuEvaluator final : public ModelEvaluator {
 public:
  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override;
  std::vector<ScatteringMatrix> scatter(const ScatteringRequest& request, const Progress& progress) override;
  EvaluationReport report() const override { return report_; }
  void clear_report() override { report_ = {}; }

 private:
  void note(bool in_double, double seconds);

  EvaluationReport report_;
};

}  // namespace dolp
