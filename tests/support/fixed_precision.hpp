#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "model/evaluator.hpp"

namespace dolp {

/// An evaluator that computes in one precision and ignores the precision that a request asks for. (A run asks first for
/// float, then for double where entries miss their tolerance.)
class FixedPrecision final : public ModelEvaluator {
 public:
  explicit FixedPrecision(Precision precision,
                          std::unique_ptr<ModelEvaluator> evaluator = std::make_unique<CpuEvaluator>())
      : evaluator_(std::move(evaluator)), precision_(precision) {}

  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override {
    MomentsRequest own = request;
    own.precision = precision_;
    return evaluator_->evaluate(own, progress);
  }
  std::vector<ScatteringMatrix> scatter(const ScatteringRequest& request, const Progress& progress) override {
    return evaluator_->scatter(request, progress);
  }
  bool has_double() const override { return precision_ == Precision::kDouble; }
  bool computes_each_entry() const override { return true; }
  EvaluationReport report() const override { return evaluator_->report(); }

 private:
  std::unique_ptr<ModelEvaluator> evaluator_;
  Precision precision_;
};

}  // namespace dolp
