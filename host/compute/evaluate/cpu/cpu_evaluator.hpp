// Moments and pBRDFs by the shaders' own source on the CPU, on all its cores.
#pragma once

#include "model/evaluator.hpp"
#include "model/moments.hpp"
#include "model/scattering.hpp"

namespace dolp {

/// Evaluator "cpu": kernel and rules of the Vulkan evaluator, compiled by the C++ compiler. The request selects the
/// precision; if it leaves the precision open, `precision` selects it, and kAuto means float.
class CpuEvaluator final : public MomentsEvaluator, public ScatteringEvaluator {
 public:
  explicit CpuEvaluator(Precision precision) : precision_(precision) {}
  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override;
  std::vector<ScatteringMatrix> scatter(const ScatteringRequest& request, const Progress& progress) override;
  Precision precision() const override { return precision_; }
  ScatteringEvaluator* scattering() override { return this; }
  EvaluationReport report() const override { return report_; }
  void clear_report() override { report_ = {}; }

 private:
  bool in_double(Precision requested) const;
  void note(bool in_double, double seconds);

  Precision precision_;
  EvaluationReport report_;
};

}  // namespace dolp
