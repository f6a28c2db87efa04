#pragma once

#include <stdexcept>
#include <vector>

#include "model/evaluator.hpp"

namespace dolp {

/// Base of evaluators that tests write. Such an evaluator has only moments, no pBRDF.
class MomentsOnly : public ModelEvaluator {
 public:
  std::vector<ScatteringMatrix> scatter(const ScatteringRequest&, const Progress&) override {
    throw std::logic_error("this evaluator has moments alone");
  }
  bool computes_each_entry() const override { return true; }
  EvaluationReport report() const override { return {}; }
};

}  // namespace dolp
