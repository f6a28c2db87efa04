// Interpolation between slope distributions: the evaluator around a made-up one, and its stated errors against the
// kernel's text at every entry.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "evaluate/interpolation/interpolating_evaluator.hpp"
#include "model/index_basis.hpp"
#include "properties_support.hpp"

namespace {

using namespace dolp;

std::vector<double> spaced(double first, double last, std::size_t count, bool in_ratios = false) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0.0;
    values.push_back(in_ratios ? first * std::pow(last / first, share) : first + (last - first) * share);
  }
  return values;
}

MomentsRequest grid_request(const Model& model, const std::vector<double>& theta_deg, const std::vector<double>& sigma,
                            const std::vector<double>& q, double tolerance = 1e-4) {
  MomentsRequest request;
  request.distribution = model.distribution;
  request.masking = model.masking;
  request.tolerance = tolerance;
  request.precision = Precision::kDouble;
  request.theta_deg = theta_deg;
  request.indices = {{1.5, 0.1}};
  request.sigma = sigma;
  request.q = q;
  return request;
}

const Model kModel = kModels[2];  // cauchy, integral

/// Moments that are a function of the slope distribution, with a bound of their own.
class Invented final : public MomentsEvaluator {
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
  EvaluationReport report() const override { return {}; }

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
  return {grid_request(kModel, {10.0, 40.0}, spaced(0.05, 1.0, 48), spaced(1.75, 8.0, 40), tolerance), known,
          InterpolatingEvaluator(std::move(inner))};
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

/// A random dense grid: ranges of sigma and q of any width up to a factor of 60 and 30, directions and indices as
/// Random draws them.
MomentsRequest random_grid(Random& random, const Model& model) {
  const bool is_smith_cauchy = model.masking == Masking::kSmith && model.distribution == Distribution::kCauchy;
  const double origin = is_smith_cauchy ? 1.5 : 1.0;
  const double sigma = random.log_uniform(1e-3, 2.0);
  const double q = random.log_uniform(0.02, 8.0);
  const std::vector<double> sigmas = spaced(sigma, std::min(10.0, sigma * random.log_uniform(1.2, 60.0)), 64, true);
  std::vector<double> qs = spaced(q, q * random.log_uniform(1.2, 30.0), 48, true);
  for (double& each : qs) each += origin;
  if (model.distribution == Distribution::kGaussian) qs = {2.0};
  MomentsRequest request =
      grid_request(model, {random.uniform(0.0, 89.9), random.chance(0.5) ? random.theta_deg() : 60.0}, sigmas, qs,
                   random.log_uniform(1e-7, 1e-2));
  request.indices = {random.index()};
  return request;
}

class RandomGrids : public testing::TestWithParam<Kernel> {};

// Against the kernel's text in double at a hundredth of the tolerance, at some of the entries.
TEST_P(RandomGrids, StatedErrors_HoldAgainstEveryEntryByItself) {
  const char* wanted = std::getenv("DOLP_PROPERTY_DRAWS");
  const int grids = wanted != nullptr ? std::atoi(wanted) : 5;
  constexpr std::size_t kChecked = 60;
  const std::unique_ptr<MomentsEvaluator> exact = make_evaluator(Kernel::kCpuDouble);
  InterpolatingEvaluator evaluator(make_evaluator(GetParam()));
  std::size_t in_all = 0;
  for (const Model& model : kModels) {
    Random random(20 + static_cast<std::uint64_t>(GetParam()));
    for (int grid = 0; grid < grids; ++grid) {
      SCOPED_TRACE(name_of(model) + " grid " + std::to_string(grid));
      MomentsRequest request = random_grid(random, model);
      request.precision = is_double(GetParam()) ? Precision::kDouble : Precision::kFloat;
      const std::vector<Moments> moments = evaluator.evaluate(request, {});
      in_all += moments.size();
      MomentsRequest some;
      some.distribution = request.distribution;
      some.masking = request.masking;
      some.precision = Precision::kDouble;
      some.tolerance = std::max(1e-2 * request.tolerance, 1e-10);
      std::vector<std::size_t> positions;
      for (std::size_t i = 0; i < kChecked; ++i) {
        positions.push_back(static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(moments.size()))));
        some.append(request[positions.back()]);
      }
      const std::vector<Moments> truth = exact->evaluate(some, {});
      for (std::size_t i = 0; i < kChecked; ++i) {
        const Point point{some[i].theta_deg, some[i].shape, some[i].index};
        expect_within_bounds(moments[positions[i]], truth[i], text_of(point));
      }
    }
  }
  EXPECT_GT(2 * evaluator.report().interpolated, in_all);
}

/// A request for a grid of indices, with their basis.
MomentsRequest random_indices(Random& random, const Model& model) {
  MomentsRequest request = grid_request(model, {random.uniform(0.0, 85.0), random.theta_deg()}, {0.05, 0.3, 1.2},
                                        {2.5, 4.0}, random.log_uniform(1e-7, 1e-2));
  if (model.distribution == Distribution::kGaussian) request.q = {2.0};
  request.wants_direct = model.masking == Masking::kVCavity || model.masking == Masking::kSmith;
  const OpticalConstants least{random.log_uniform(0.2, 20.0), random.log_uniform(1e-3, 20.0)};
  request.indices.clear();
  for (const double n : spaced(least.n, least.n * random.log_uniform(1.2, 3.0), 12)) {
    for (const double k : spaced(least.k, least.k * random.log_uniform(1.2, 3.0), 10))
      request.indices.push_back({n, k});
  }
  request.basis = IndexBasis::of(request.indices, request.tolerance);
  return request;
}

// Against each index by itself.
TEST_P(RandomGrids, StatedErrors_HoldAgainstEveryIndexByItself) {
  const std::unique_ptr<MomentsEvaluator> exact = make_evaluator(Kernel::kCpuDouble);
  InterpolatingEvaluator evaluator(make_evaluator(GetParam()));
  std::size_t combined = 0;
  for (const Model& model : kModels) {
    Random random(40 + static_cast<std::uint64_t>(GetParam()));
    SCOPED_TRACE(name_of(model));
    MomentsRequest request = random_indices(random, model);
    request.precision = is_double(GetParam()) ? Precision::kDouble : Precision::kFloat;
    const std::vector<Moments> moments = evaluator.evaluate(request, {});
    if (request.basis) combined += moments.size();
    MomentsRequest alone = request;
    alone.basis = nullptr;
    alone.may_interpolate = false;
    alone.precision = Precision::kDouble;
    alone.tolerance = std::max(1e-2 * request.tolerance, 1e-10);
    const std::vector<Moments> truth = exact->evaluate(alone, {});
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const Point point{request[i].theta_deg, request[i].shape, request[i].index};
      expect_within_bounds(moments[i], truth[i], text_of(point));
    }
  }
  EXPECT_GT(combined, 0U);
  EXPECT_EQ(evaluator.report().interpolated, combined);
  EXPECT_LE(2 * evaluator.report().interpolation_nodes, combined);
}

INSTANTIATE_TEST_SUITE_P(Kernels, RandomGrids, testing::ValuesIn(kKernels),
                         [](const auto& tested) { return name_of(tested.param); });

}  // namespace
