// An evaluator that computes dense requests at fewer indices and slope distributions than they have.
#pragma once

#include <memory>
#include <utility>

#include "model/evaluator.hpp"
#include "model/moments.hpp"

namespace dolp {

/// Wraps another evaluator, which computes responses for many indices (response_plan.hpp), the nodes of dense grids
/// (shape_plan.hpp) and all requests that are not dense.
class InterpolatingEvaluator final : public ModelEvaluator {
 public:
  explicit InterpolatingEvaluator(std::unique_ptr<ModelEvaluator> evaluator) : evaluator_(std::move(evaluator)) {}

  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override;
  std::vector<ScatteringMatrix> scatter(const ScatteringRequest& request, const Progress& progress) override {
    return evaluator_->scatter(request, progress);
  }
  void prepare(const ScatteringRequest& request) override { evaluator_->prepare(request); }
  bool has_double() const override { return evaluator_->has_double(); }
  std::vector<char> interpolated_directions(const MomentsRequest& request) const override;
  EvaluationReport report() const override;
  void clear_report() override;

 private:
  /// Without interpolation between slope distributions.
  std::vector<Moments> computed(const MomentsRequest& request, const Progress& progress);
  std::vector<Moments> combined_from_responses(const MomentsRequest& request, const Progress& progress);
  /// Directions of one shape parameter.
  std::vector<Moments> evaluate_part(const MomentsRequest& request, const Progress& progress);

  std::unique_ptr<ModelEvaluator> evaluator_;
  std::uint64_t interpolated_ = 0;
  std::uint64_t nodes_ = 0;
  double interpolation_s_ = 0.0;
};

}  // namespace dolp
