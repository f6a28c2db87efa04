// Interpolation between slope distributions: the evaluator around a made-up one, whose moments are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "evaluate/interpolation/interpolating_evaluator.hpp"
#include "moments_only.hpp"
#include "properties_support.hpp"

namespace {

using namespace dolp;

std::vector<double> spaced(double first, double last, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(first + (last - first) * static_cast<double>(i) / static_cast<double>(count - 1));
  }
  return values;
}

/// Moments that are a function of the slope distribution, with a bound of their own.
class Invented final : public MomentsOnly {
 public:
  using Function = double (*)(const SlopeShape&);
  Invented(Function function, double error) : function_(function), error_(error) {}

  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override {
    requests.push_back(request);
    std::vector<Moments> moments;
    for (std::size_t i = 0; i < request.size(); ++i) {
      const double r = function_(request[i].shape);
      moments.push_back({.r_i = r,
                         .r_q = -0.5 * r,
                         .albedo = 2.0 * r,
                         .deficit = 1.0 - r,
                         .r_i_error = error_,
                         .r_q_error = error_,
                         .albedo_error = error_,
                         .deficit_error = error_,
                         .evaluations = 10.0});
      if (progress && !progress(moments.size(), request.size())) throw Cancelled();
    }
    return moments;
  }

  std::vector<MomentsRequest> requests;

 private:
  Function function_;
  double error_;
};

struct Interpolated {
  MomentsRequest request;
  Invented* inner;
  InterpolatingEvaluator evaluator;
};

Interpolated interpolated(Invented::Function function, double error = 0.0, double tolerance = 1e-4) {
  auto inner = std::make_unique<Invented>(function, error);
  Invented* const known = inner.get();
  MomentsRequest request;
  request.tolerance = tolerance;
  request.precision = Precision::kDouble;
  request.theta_deg = {10.0, 40.0};
  request.indices = {{1.5, 0.1}};
  request.sigma = spaced(0.05, 1.0, 48);
  request.q = spaced(1.75, 8.0, 40);
  return {std::move(request), known, InterpolatingEvaluator(std::move(inner))};
}

/// The largest error over what is stated, and the largest statement over r_i.
struct Check {
  double worst_share = 0.0;
  double largest_bound = 0.0;
};

Check check(const MomentsRequest& request, const std::vector<Moments>& moments, Invented::Function function) {
  Check result;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const double r = function(request[i].shape);
    const Moments& m = moments[i];
    for (const auto& [value, truth, bound] :
         {std::tuple{m.r_i, r, m.r_i_error}, std::tuple{m.r_q, -0.5 * r, m.r_q_error},
          std::tuple{m.albedo, 2.0 * r, m.albedo_error}, std::tuple{m.deficit, 1.0 - r, m.deficit_error}}) {
      constexpr double kRounding = 1e-14;
      result.worst_share = std::max(result.worst_share, std::abs(value - truth) / (bound + kRounding));
    }
    result.largest_bound = std::max(result.largest_bound, m.r_i_error / r);
  }
  return result;
}

// A test function with the features of real moments: a peak that moves with sigma, a power that q sets.
double smooth(const SlopeShape& shape) {
  const double m2 = 2.0 * shape.sigma * shape.sigma;
  return 0.05 + 1.0 - std::pow(m2 / (0.3 + m2), shape.q - 1.0);
}

double kinked(const SlopeShape& shape) { return 1.0 + std::abs(std::log(shape.sigma / 0.3)) * shape.q; }

TEST(InterpolatingEvaluator, SmoothMoments_KeepTheToleranceAndTheStatedErrors) {
  for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-9}) {
    Interpolated one = interpolated(smooth, 0.0, tolerance);
    const std::vector<Moments> moments = one.evaluator.evaluate(one.request, {});
    ASSERT_EQ(moments.size(), one.request.size());
    const Check result = check(one.request, moments, smooth);
    EXPECT_LE(result.worst_share, 1.0) << tolerance;
    EXPECT_LE(result.largest_bound, tolerance);
    EXPECT_EQ(one.evaluator.report().interpolated, moments.size());
    EXPECT_EQ(one.evaluator.report().interpolation_nodes, one.inner->requests.at(0).size());
  }
}

TEST(InterpolatingEvaluator, MomentsWithAKink_StateALargeError) {
  Interpolated one = interpolated(kinked);
  const Check result = check(one.request, one.evaluator.evaluate(one.request, {}), kinked);
  EXPECT_LE(result.worst_share, 1.0);
  EXPECT_GT(result.largest_bound, one.request.tolerance);
}

TEST(InterpolatingEvaluator, BoundsOfTheNodes_AreCarriedOver) {
  constexpr double kError = 1e-3;
  Interpolated one = interpolated(smooth, kError);
  for (const Moments& m : one.evaluator.evaluate(one.request, {})) {
    EXPECT_GE(m.r_i_error, 0.999 * kError);
    EXPECT_LE(m.r_i_error, 20.0 * kError);
  }
}

TEST(InterpolatingEvaluator, NodeWithoutABound_ItsDirectionIsComputedEntryByEntry) {
  const Invented::Function infinite = [](const SlopeShape& shape) {
    return shape.q == 8.0 ? std::numeric_limits<double>::infinity() : smooth(shape);
  };
  Interpolated one = interpolated(infinite);
  const std::vector<Moments> moments = one.evaluator.evaluate(one.request, {});
  ASSERT_EQ(one.inner->requests.size(), 2U);
  EXPECT_EQ(one.inner->requests[1].size(), one.request.size());
  EXPECT_EQ(one.inner->requests[1].tolerance, one.request.tolerance);
  EXPECT_EQ(one.evaluator.report().interpolated, 0U);
  for (std::size_t i = 0; i < moments.size(); ++i) {
    EXPECT_EQ(moments[i].r_i, infinite(one.request[i].shape));
  }
}

TEST(InterpolatingEvaluator, Progress_RisesToAll_AndCancels) {
  Interpolated one = interpolated(smooth);
  std::vector<std::size_t> done;
  one.evaluator.evaluate(one.request, [&](std::size_t now, std::size_t total) {
    EXPECT_EQ(total, one.request.size());
    done.push_back(now);
    return true;
  });
  EXPECT_TRUE(std::ranges::is_sorted(done));
  EXPECT_EQ(done.back(), one.request.size());
  EXPECT_THROW(one.evaluator.evaluate(one.request, [](std::size_t, std::size_t) { return false; }), Cancelled);
}

}  // namespace
