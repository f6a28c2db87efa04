#pragma once

#include "model/evaluator.hpp"
#include "model/moments.hpp"
#include "model/scattering.hpp"

namespace dolp {

/// The evaluator "cpu". It runs the kernel source (shaders/physics/), compiled as C++.
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
