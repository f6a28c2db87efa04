// An artificial evaluator carries out a MomentsPlan. Its moments are known functions of the slope distribution.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "draws.hpp"
#include "evaluate/planned_moments.hpp"
#include "moments_only.hpp"
#include "properties_support.hpp"

namespace planned_moments_test {

using namespace dolp;

/// An evaluator whose moments are a given function of the slope distribution, with error bounds of 0.
class Invented final : public MomentsOnly {
 public:
  using Function = double (*)(const SlopeShape&);
  explicit Invented(Function function) : function_(function) {}

  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override {
    requests.push_back(request);
    std::vector<Moments> moments;
    for (std::size_t i = 0; i < request.size(); ++i) {
      const double r = function_(request[i].shape);
      moments.push_back({.r_i = r,
                         .r_q = -0.5 * r,
                         .albedo = 2.0 * r,
                         .deficit = 1.0 - r,
                         .r_i_error = 0.0,
                         .r_q_error = 0.0,
                         .albedo_error = 0.0,
                         .deficit_error = 0.0,
                         .evaluations = 10.0});
      if (progress && !progress(moments.size(), request.size())) throw Cancelled();
    }
    return moments;
  }

  std::vector<MomentsRequest> requests;

 private:
  Function function_;
};

MomentsRequest dense_request() {
  MomentsRequest request;
  request.tolerance = 1e-4;
  request.precision = Precision::kDouble;
  request.theta_deg = {10.0, 40.0};
  request.optics = {{1.5, 0.1}};
  request.shapes = shape_product(spaced(0.05, 1.0, 48), spaced(1.75, 8.0, 40));
  request.set_grid();
  return request;
}

// A smooth test function: 0.05 plus the share of facets of a Cauchy surface whose squared slope is below 0.3.
double smooth(const SlopeShape& shape) {
  const double m2 = 2.0 * shape.sigma * shape.sigma;
  return 0.05 + 1.0 - std::pow(m2 / (0.3 + m2), shape.q - 1.0);
}

double kinked(const SlopeShape& shape) { return 1.0 + std::abs(std::log(shape.sigma / 0.3)) * shape.q; }

TEST(PlannedMoments, MomentsWithAKink_StateALargeError) {
  const MomentsRequest request = dense_request();
  Invented invented(kinked);
  Work work;
  constexpr double kRounding = 1e-14;
  const std::vector<Moments> moments = planned_moments(MomentsPlan(request), invented, {}, work).all();
  double largest_bound = 0.0;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const double r = kinked(request[i].shape);
    EXPECT_NEAR(moments[i].r_i, r, moments[i].r_i_error + kRounding);
    EXPECT_NEAR(moments[i].r_q, -0.5 * r, moments[i].r_q_error + kRounding);
    largest_bound = std::max(largest_bound, moments[i].r_i_error / r);
  }
  EXPECT_GT(largest_bound, request.tolerance);
}

TEST(PlannedMoments, NodeWithoutABound_ItsDirectionIsComputedEntryByEntry) {
  const Invented::Function infinite = [](const SlopeShape& shape) {
    return shape.q == 8.0 ? std::numeric_limits<double>::infinity() : smooth(shape);
  };
  const MomentsRequest request = dense_request();
  Invented invented(infinite);
  Work work;
  const std::vector<Moments> moments = planned_moments(MomentsPlan(request), invented, {}, work).all();
  ASSERT_EQ(invented.requests.size(), 2U);
  EXPECT_EQ(invented.requests[1].size(), request.size());
  EXPECT_EQ(invented.requests[1].tolerance, request.tolerance);
  EXPECT_EQ(work.interpolated, 0U);
  for (std::size_t i = 0; i < moments.size(); ++i) {
    EXPECT_EQ(moments[i].r_i, infinite(request[i].shape));
  }
}

TEST(PlannedMoments, Progress_RisesToAll_AndCancels) {
  const MomentsPlan plan(dense_request());
  Invented invented(smooth);
  Work work;
  std::vector<std::size_t> done;
  const auto note = [&](std::size_t now, std::size_t total) {
    EXPECT_EQ(total, plan.size());
    done.push_back(now);
    return true;
  };
  planned_moments(plan, invented, note, work);
  EXPECT_TRUE(std::ranges::is_sorted(done));
  EXPECT_EQ(done.back(), plan.size());
  const auto cancel = [](std::size_t, std::size_t) { return false; };
  EXPECT_THROW(planned_moments(plan, invented, cancel, work), Cancelled);
}

}  // namespace planned_moments_test
