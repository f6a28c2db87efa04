// An evaluator that returns stored reference moments, so that tests can run a scene with exact moments.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <map>
#include <tuple>
#include <vector>

#include "model/moments.hpp"
#include "moments_only.hpp"
#include "verify/qualification.hpp"

namespace dolp {

/// Knows the stored cases of one distribution and masking. A request for any other entry fails the test.
class StoredEvaluator final : public MomentsOnly {
 public:
  explicit StoredEvaluator(const std::vector<StoredCase>& cases) {
    for (const StoredCase& c : cases) moments_[key(c.theta_deg, c.shape, c.index)] = c.moments;
  }

  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress&) override {
    std::vector<Moments> results;
    for (std::size_t i = 0; i < request.size(); ++i) {
      const MomentsPoint point = request[i];
      const auto found = moments_.find(key(point.theta_deg, point.shape, point.index.index));
      EXPECT_NE(found, moments_.end());
      results.push_back(found == moments_.end() ? Moments{} : found->second);
    }
    return results;
  }

 private:
  using Key = std::tuple<double, double, double, double, double>;
  static Key key(double theta_deg, const SlopeShape& shape, const OpticalConstants& index) {
    return {theta_deg, shape.sigma, shape.q, index.n, index.k};
  }
  std::map<Key, Moments> moments_;
};

inline std::vector<StoredCase> cases_of(const std::vector<StoredCase>& cases, Distribution distribution,
                                        Masking masking) {
  std::vector<StoredCase> own;
  for (const StoredCase& c : cases) {
    if (c.distribution == distribution && c.masking == masking) own.push_back(c);
  }
  return own;
}

}  // namespace dolp
