#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "model/evaluator.hpp"

namespace dolp {

/// Passes requests on to another evaluator, and remembers the moments of those requests for which `is_repeated` is
/// true.
class RememberingEvaluator final : public ModelEvaluator {
 public:
  using IsRepeated = bool (*)(const MomentsRequest&);

  RememberingEvaluator(ModelEvaluator& evaluator, IsRepeated is_repeated)
      : evaluator_(evaluator), is_repeated_(is_repeated) {}

  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override {
    if (!is_repeated_(request)) return evaluator_.evaluate(request, progress);
    const auto known = std::ranges::find(known_, request, &std::pair<MomentsRequest, std::vector<Moments>>::first);
    if (known != known_.end()) return known->second;
    if (known_.size() == kMostKnown) known_.erase(known_.begin());
    return known_.emplace_back(request, evaluator_.evaluate(request, progress)).second;
  }
  std::vector<ScatteringMatrix> scatter(const ScatteringRequest& request, const Progress& progress) override {
    return evaluator_.scatter(request, progress);
  }
  TransmissionIntegral transmission() const override { return evaluator_.transmission(); }
  bool has_double() const override { return evaluator_.has_double(); }
  bool computes_each_entry() const override { return evaluator_.computes_each_entry(); }
  EvaluationReport report() const override { return evaluator_.report(); }

 private:
  static constexpr std::size_t kMostKnown = 64;

  ModelEvaluator& evaluator_;
  IsRepeated is_repeated_;
  std::vector<std::pair<MomentsRequest, std::vector<Moments>>> known_;
};

}  // namespace dolp
