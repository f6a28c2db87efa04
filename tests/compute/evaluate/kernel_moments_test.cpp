// A result does not depend on how a request orders and groups its entries. The entries are drawn at random from the
// whole range, with fixed seeds.
#include <gtest/gtest.h>

#include <cstdio>
#include <numeric>
#include <string>
#include <vector>

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "model/angles.hpp"
#include "properties_support.hpp"

namespace dolp {
namespace {

constexpr std::uint64_t kSeed = 20260403;

std::uint64_t printed_seed(std::uint64_t offset) {
  std::printf("seed %s\n", std::to_string(kSeed + offset).c_str());
  return kSeed + offset;
}

std::uint64_t number_of(const Model& model) {
  return 2 * static_cast<std::uint64_t>(model.masking) + static_cast<std::uint64_t>(model.distribution);
}

class KernelProperties : public testing::TestWithParam<KernelAndModel> {};

/// A request for a grid of random axes. It wants the moments of only a third of the entries.
MomentsRequest random_grid(const Model& model, Random& random) {
  MomentsRequest request = request_of(model, {}, 1e-3);
  for (int i = 0; i < 6; ++i) request.theta_deg.push_back(random.theta_deg());
  for (int i = 0; i < 4; ++i) request.optics.push_back(random.index());
  for (int i = 0; i < 3; ++i) {
    request.sigma.push_back(random.shape(model).sigma);
    request.q.push_back(random.shape(model).q);
  }
  for (std::size_t i = 0; i < request.size(); ++i) request.wanted.push_back(random.chance(1.0 / 3.0) ? 1 : 0);
  return request;
}

/// Numbers 0 to count - 1 in random order.
std::vector<std::size_t> permutation(std::size_t count, Random& random) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i) {
    std::swap(order[i - 1], order[static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(i)))]);
  }
  return order;
}

template <class Value>
std::vector<Value> permuted(const std::vector<Value>& values, const std::vector<std::size_t>& order) {
  std::vector<Value> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) result[order[i]] = values[i];
  return result;
}

/// A request with reordered axes, and the new position of each entry of the original request.
struct Reordered {
  MomentsRequest request;
  std::vector<std::size_t> place_of;
};

Reordered reordered(const MomentsRequest& request, Random& random) {
  const auto thetas = permutation(request.theta_deg.size(), random);
  const auto indices = permutation(request.optics.size(), random);
  const auto sigmas = permutation(request.sigma.size(), random);
  const auto qs = permutation(request.q.size(), random);
  Reordered other{request, {}};
  other.request.theta_deg = permuted(request.theta_deg, thetas);
  other.request.optics = permuted(request.optics, indices);
  other.request.sigma = permuted(request.sigma, sigmas);
  other.request.q = permuted(request.q, qs);
  for (const std::size_t index : indices) {
    for (const std::size_t theta : thetas) {
      for (const std::size_t sigma : sigmas) {
        for (const std::size_t q : qs) {
          other.place_of.push_back(((index * thetas.size() + theta) * sigmas.size() + sigma) * qs.size() + q);
        }
      }
    }
  }
  for (std::size_t i = 0; i < request.size(); ++i) other.request.wanted[other.place_of[i]] = request.wanted[i];
  return other;
}

TEST_P(KernelProperties, OrderOfAxes_TilesAndBlocks_ChangeNoBit) {
  const auto [kernel, model] = GetParam();
  Random random(printed_seed(600 + number_of(model)));
  const MomentsRequest request = random_grid(model, random);
  const std::vector<Moments> expected = make_evaluator(kernel)->evaluate(request, {});
  ASSERT_GT(request.wanted_count(), 10U);
  for (int round = 0; round < 3; ++round) {
    const Reordered other = reordered(request, random);
    VulkanOptions options;
    options.first_tile_invocations = static_cast<std::uint32_t>(random.uniform(1.0, 20.0));
    options.max_tile_invocations = static_cast<std::uint32_t>(random.uniform(1.0, 40.0));
    // In round 0 the limit is 1 shape. A row of a kernel may need more shapes, so the evaluator must raise the limit.
    options.max_block_shapes = round == 0 ? 1 : static_cast<std::uint32_t>(random.uniform(1.0, 6.0));
    options.staged_uploads = random.chance(0.5);
    const std::vector<Moments> actual = make_evaluator(kernel, options)->evaluate(other.request, {});
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      if (!request.is_wanted(i)) continue;
      EXPECT_TRUE(are_same(expected[i], actual[other.place_of[i]])) << "entry " << i << " in round " << round;
    }
  }
}

// These shapes need more masking tables than the evaluator holds at one time.
TEST(CpuEvaluator, ManyShapes_HaveTheBitsOfEachByItself) {
  constexpr std::size_t kShapes = 9000;
  MomentsRequest request{.masking = Masking::kSmith,
                         .tolerance = 1e-2,
                         .theta_deg = {30.0, 70.0},
                         .optics = {{1.5, 0.0}},
                         .sigma = {0.3},
                         .q = {}};
  for (std::size_t i = 0; i < kShapes; ++i) request.q.push_back(2.0 + 1e-4 * static_cast<double>(i));
  const std::vector<Moments> all = CpuEvaluator().evaluate(request, {});
  for (const std::size_t shape : {std::size_t{0}, std::size_t{4095}, std::size_t{4096}, kShapes - 1}) {
    MomentsRequest own = request;
    own.q = {request.q[shape]};
    const std::vector<Moments> one = CpuEvaluator().evaluate(own, {});
    for (std::size_t theta = 0; theta < 2; ++theta) {
      EXPECT_EQ(all[theta * kShapes + shape].r_i, one[theta].r_i) << shape;
      EXPECT_EQ(all[theta * kShapes + shape].r_q, one[theta].r_q) << shape;
      EXPECT_GT(one[theta].r_i, 0.0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, KernelProperties,
                         testing::Combine(testing::ValuesIn(kKernels), testing::ValuesIn(kModels)),
                         kernel_and_model_name);

}  // namespace
}  // namespace dolp
