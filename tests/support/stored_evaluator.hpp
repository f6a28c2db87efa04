// Stored reference moments behind the interface of evaluators, so that any scene can have its reference results.
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

/// Returns the moments of stored cases of one distribution and masking. Any other request is a failure of the test.
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

/// The cases of one distribution and masking.
inline std::vector<StoredCase> cases_of(const std::vector<StoredCase>& cases, Distribution distribution,
                                        Masking masking) {
  std::vector<StoredCase> own;
  for (const StoredCase& c : cases) {
    if (c.distribution == distribution && c.masking == masking) own.push_back(c);
  }
  return own;
}

}  // namespace dolp
