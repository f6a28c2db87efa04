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

namespace dolp::kernel_moments_test {
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

/// A grid of random axes, of which a third of the entries are chosen.
struct ChosenEntries {
  MomentsRequest lists;
  std::vector<double> sigma, q;
  std::vector<std::size_t> chosen = {};  // numbers in the whole grid

  MomentsRequest whole() const {
    MomentsRequest request = lists;
    request.shapes = shape_product(sigma, q);
    request.set_grid();
    return request;
  }
  MomentsRequest request() const { return whole().select_entries(chosen); }
};

ChosenEntries random_entries(const Model& model, Random& random) {
  ChosenEntries entries{request_of(model, {}, 1e-3), {}, {}};
  for (int i = 0; i < 6; ++i) entries.lists.theta_deg.push_back(random.theta_deg());
  for (int i = 0; i < 4; ++i) entries.lists.optics.push_back(random.index());
  for (int i = 0; i < 3; ++i) {
    entries.sigma.push_back(random.shape(model).sigma);
    entries.q.push_back(random.shape(model).q);
  }
  for (std::size_t i = 0; i < entries.whole().size(); ++i) {
    if (random.chance(1.0 / 3.0)) entries.chosen.push_back(i);
  }
  return entries;
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

/// The same entries with reordered axes, and the new position of each chosen entry.
struct Reordered {
  ChosenEntries entries;
  std::vector<std::size_t> place_of;
};

Reordered reordered(const ChosenEntries& entries, Random& random) {
  const auto thetas = permutation(entries.lists.theta_deg.size(), random);
  const auto indices = permutation(entries.lists.optics.size(), random);
  const auto sigmas = permutation(entries.sigma.size(), random);
  const auto qs = permutation(entries.q.size(), random);
  Reordered other{entries, {}};
  other.entries.lists.theta_deg = permuted(entries.lists.theta_deg, thetas);
  other.entries.lists.optics = permuted(entries.lists.optics, indices);
  other.entries.sigma = permuted(entries.sigma, sigmas);
  other.entries.q = permuted(entries.q, qs);
  std::vector<std::size_t> in_whole;
  for (std::size_t i : entries.chosen) {
    const std::size_t q = qs[i % qs.size()], sigma = sigmas[(i /= qs.size()) % sigmas.size()];
    const std::size_t theta = thetas[(i /= sigmas.size()) % thetas.size()], index = indices[i / thetas.size()];
    in_whole.push_back(((index * thetas.size() + theta) * sigmas.size() + sigma) * qs.size() + q);
  }
  other.entries.chosen = in_whole;
  std::ranges::sort(other.entries.chosen);
  for (const std::size_t i : in_whole)
    other.place_of.push_back(
        static_cast<std::size_t>(std::ranges::lower_bound(other.entries.chosen, i) - other.entries.chosen.begin()));
  return other;
}

TEST_P(KernelProperties, OrderOfAxes_TilesAndBlocks_ChangeNoBit) {
  const auto [kernel, model] = GetParam();
  Random random(printed_seed(600 + number_of(model)));
  const ChosenEntries entries = random_entries(model, random);
  const std::vector<Moments> expected = make_evaluator(kernel)->evaluate(entries.request(), {});
  ASSERT_GT(expected.size(), 10U);
  for (int round = 0; round < 2; ++round) {
    const Reordered other = reordered(entries, random);
    VulkanOptions options;
    options.first_tile_invocations = static_cast<std::uint32_t>(random.uniform(1.0, 20.0));
    options.max_tile_invocations = static_cast<std::uint32_t>(random.uniform(1.0, 40.0));
    // In round 0 the limit is 1 shape. A row of a kernel may need more shapes, so the evaluator must raise the limit.
    options.max_block_shapes = round == 0 ? 1 : static_cast<std::uint32_t>(random.uniform(1.0, 6.0));
    options.staged_uploads = random.chance(0.5);
    const std::vector<Moments> actual = make_evaluator(kernel, options)->evaluate(other.entries.request(), {});
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_TRUE(are_same(expected[i], actual[other.place_of[i]])) << "entry " << i << " in round " << round;
  }
}

// These shapes need more masking tables than the evaluator holds at one time.
TEST(CpuEvaluator, ManyShapes_HaveTheBitsOfEachByItself) {
  constexpr std::size_t kShapes = 9000;
  MomentsRequest request;
  request.masking = Masking::kSmith;
  request.tolerance = 1e-2;
  request.theta_deg = {30.0, 70.0};
  request.optics = {{1.5, 0.0}};
  for (std::size_t i = 0; i < kShapes; ++i) request.shapes.push_back({0.3, 2.0 + 1e-4 * static_cast<double>(i)});
  request.set_grid();
  const std::vector<Moments> all = CpuEvaluator().evaluate(request, {});
  for (const std::size_t shape : {std::size_t{0}, std::size_t{4095}, std::size_t{4096}, kShapes - 1}) {
    MomentsRequest own = request;
    own.set_shapes({request.shapes[shape]});
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
}  // namespace dolp::kernel_moments_test
