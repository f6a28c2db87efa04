// Groups of entries that differ in q alone: who is grouped, and that the kernel says the same of each alone.
#include "plan/groups.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>
#include <tuple>

#include "evaluate/vulkan/vulkan_evaluator.hpp"

namespace dolp {
namespace {

constexpr std::uint32_t kSize = 8;
constexpr std::array<std::uint32_t, 2> kSizes = {1, kSize};

// Every combination of the lists.
MomentsRequest grid(Masking masking, const std::vector<double>& theta_deg, const std::vector<double>& sigma,
                    const std::vector<double>& q, const std::vector<OpticalConstants>& indices) {
  MomentsRequest request;
  request.masking = masking;
  request.theta_deg = theta_deg;
  request.indices = indices;
  for (const double s : sigma) {
    for (const double exponent : q) request.shapes.push_back({s, exponent});
  }
  for (std::uint32_t theta = 0; theta < theta_deg.size(); ++theta) {
    for (std::uint32_t shape = 0; shape < request.shapes.size(); ++shape) {
      for (std::uint32_t index = 0; index < indices.size(); ++index) request.entries.push_back({theta, shape, index});
    }
  }
  return request;
}

const std::vector<double> kManyQ = {1.7, 1.8, 2.0, 2.1, 2.2, 2.3, 2.5, 2.6, 3.0, 3.5, 4.0, 5.0};

TEST(Grouped, EveryEntry_HasAPlaceInAGroupOfItsOwnDirectionIndexAndShape) {
  const MomentsRequest request =
      grid(Masking::kIntegral, {0.0, 30.0, 60.0}, {0.1, 0.3}, kManyQ, {{1.5, 0.0}, {0.9, 0.0}});
  const KernelData data = kernel_data(request);
  const Grouping grouping = grouped(data, kSizes, kSizes);
  EXPECT_EQ(grouping.size, kSize);
  ASSERT_EQ(grouping.places.size(), data.entries.size());
  std::set<std::pair<std::uint32_t, std::uint32_t>> places;
  std::vector<std::uint32_t> used(grouping.groups.size());
  for (std::size_t i = 0; i < data.entries.size(); ++i) {
    const EntryPlace& place = grouping.places[i];
    const EntryGroup& group = grouping.groups.at(place.group);
    const ShapeFamily& family = grouping.families.at(group.family);
    ASSERT_LT(place.member, family.count);
    EXPECT_LE(family.count, kSize);
    EXPECT_EQ(group.theta, data.entries[i].theta);
    EXPECT_EQ(group.index, data.entries[i].index);
    const kernel::ShapeNode& own = data.shapes[data.entries[i].shape];
    const kernel::ShapeNode& grouped_shape = grouping.shapes[family.first + place.member];
    EXPECT_EQ(grouped_shape.m, own.m);
    EXPECT_EQ(grouped_shape.q_minus_1, own.q_minus_1);
    EXPECT_EQ(grouped_shape.marginal_norm, own.marginal_norm);
    EXPECT_TRUE(places.emplace(place.group, place.member).second);
    ++used[place.group];
  }
  for (std::size_t g = 0; g < used.size(); ++g) EXPECT_EQ(used[g], grouping.groups[g].used);
}

TEST(Grouped, Families_ShareTheHardestNeedsAndAscendInQ) {
  const KernelData data = kernel_data(grid(Masking::kSmith, {30.0}, {0.05, 0.9}, kManyQ, {{1.5, 0.0}}));
  const Grouping grouping = grouped(data, kSizes, kSizes);
  double widest = 0.0;
  for (const ShapeFamily& family : grouping.families) {
    const kernel::ShapeNode& first = grouping.shapes[family.first];
    for (std::uint32_t g = 1; g < family.count; ++g) {
      const kernel::ShapeNode& shape = grouping.shapes[family.first + g];
      EXPECT_EQ(shape.m, first.m);
      EXPECT_GT(shape.q_minus_1, grouping.shapes[family.first + g - 1].q_minus_1);
      EXPECT_EQ(std::tie(shape.scale, shape.cut, shape.table_scale, shape.cusp_digits),
                std::tie(first.scale, first.cut, first.table_scale, first.cusp_digits));
      widest = std::max(widest, shape.q_minus_1 / first.q_minus_1);
    }
    for (const kernel::ShapeNode& own : data.shapes) {
      const bool is_member = own.m == first.m && own.q_minus_1 >= first.q_minus_1 &&
                             own.q_minus_1 <= grouping.shapes[family.first + family.count - 1].q_minus_1;
      if (!is_member) continue;
      EXPECT_LE(first.scale, own.scale);
      EXPECT_GE(first.cut, own.cut);
      EXPECT_GE(first.cusp_digits, own.cusp_digits);
    }
  }
  EXPECT_GT(widest, 1.5);
}

TEST(Grouped, EntriesThatShareNothing_AreAlone) {
  MomentsRequest request = grid(Masking::kNone, {10.0, 20.0, 40.0}, {0.1, 0.2, 0.4}, {2.0}, {{1.5, 0.0}});
  EXPECT_EQ(grouped(kernel_data(request), kSizes, kSizes).size, 1U);
  request = grid(Masking::kNone, {10.0}, {0.1}, kManyQ, {{1.5, 0.0}});
  EXPECT_EQ(grouped(kernel_data(request), kSizes, kSizes).size, kSize);
  EXPECT_EQ(grouped(kernel_data(request), std::array{1U}).size, 1U);
  request.distribution = Distribution::kGaussian;  // which has no q
  EXPECT_EQ(grouped(kernel_data(request), kSizes, kSizes).size, 1U);
}

TEST(Grouped, SmallRequest_IsNotWorthAKernelOfItsOwn) {
  const std::vector<double> theta_deg = {5.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0};
  MomentsRequest request = grid(Masking::kNone, theta_deg, {0.1, 0.2}, kManyQ, {{1.5, 0.0}});
  EXPECT_EQ(grouped(kernel_data(request), kSizes).size, 1U);
  for (std::uint32_t i = 1; i < 400; ++i) request.indices.push_back({1.5 + 0.01 * i, 0.0});
  const std::vector<MomentsEntry> of_one = request.entries;
  for (std::uint32_t i = 1; i < 400; ++i) {
    for (MomentsEntry entry : of_one) {
      entry.index = i;
      request.entries.push_back(entry);
    }
  }
  EXPECT_EQ(grouped(kernel_data(request), kSizes).size, kSize);
}

bool same(const Moments& a, const Moments& b) {
  return std::tie(a.r_i, a.r_q, a.albedo, a.deficit, a.r_i_error, a.r_q_error, a.albedo_error, a.deficit_error,
                  a.evaluations) == std::tie(b.r_i, b.r_q, b.albedo, b.deficit, b.r_i_error, b.r_q_error,
                                             b.albedo_error, b.deficit_error, b.evaluations);
}

class GroupedKernel : public testing::TestWithParam<std::tuple<Masking, Precision>> {};

// The members of a group have other nodes than each alone: both are right within their bounds.
TEST_P(GroupedKernel, Members_AgreeWithEachAloneWithinTheBounds) {
  const auto [masking, precision] = GetParam();
  const double tolerance = precision == Precision::kDouble ? 1e-7 : 1e-4;
  MomentsRequest request = grid(masking, {0.0, 20.0, 45.0, 70.0, 88.0, 89.9}, {0.02, 0.3, 1.0}, kManyQ,
                                {{1.508, 0.0}, {27.0, 90.0}, {0.8, 0.0}});
  request.tolerance = tolerance;
  request.precision = precision;
  VulkanOptions options;
  options.precision = precision;
  options.validation = ValidationMode::kOn;
  options.groups_small_requests = true;
  VulkanEvaluator evaluator(options);
  const std::vector<Moments> together = evaluator.evaluate(request, {});
  // one q at a time: nothing to group
  double shared = 0.0, alone_evaluations = 0.0;
  for (std::size_t wanted = 0; wanted < kManyQ.size(); ++wanted) {
    MomentsRequest single = request;
    std::vector<std::size_t> positions;
    single.entries.clear();
    for (std::size_t i = 0; i < request.entries.size(); ++i) {
      if (request.entries[i].shape % kManyQ.size() != wanted) continue;
      single.entries.push_back(request.entries[i]);
      positions.push_back(i);
    }
    const std::vector<Moments> alone = evaluator.evaluate(single, {});
    for (std::size_t k = 0; k < alone.size(); ++k) {
      const Moments& a = alone[k];
      const Moments& b = together[positions[k]];
      EXPECT_LE(std::abs(a.r_i - b.r_i), a.r_i_error + b.r_i_error) << positions[k];
      EXPECT_LE(std::abs(a.r_q - b.r_q), a.r_q_error + b.r_q_error) << positions[k];
      EXPECT_LE(std::abs(a.albedo - b.albedo), a.albedo_error + b.albedo_error) << positions[k];
      EXPECT_LE(std::abs(a.deficit - b.deficit), a.deficit_error + b.deficit_error) << positions[k];
      shared += b.evaluations;
      alone_evaluations += a.evaluations;
    }
  }
  std::printf("evaluations: %.3g together, %.3g alone\n", shared, alone_evaluations);
  // the cusp of smith that tight tolerances split off leaves few families
  const bool shares = masking != Masking::kSmith || precision == Precision::kFloat;
  EXPECT_LT(shared, shares ? 0.5 * alone_evaluations : 1.01 * alone_evaluations);
}

// Neither the order of the entries nor that of the lists matters.
TEST_P(GroupedKernel, ShuffledRequest_HasTheSameBits) {
  const auto [masking, precision] = GetParam();
  MomentsRequest request = grid(masking, {30.0, 75.0}, {0.1, 0.5}, kManyQ, {{1.508, 0.0}, {3.0, 2.0}});
  request.precision = precision;
  VulkanOptions options;
  options.precision = precision;
  options.validation = ValidationMode::kOn;
  options.groups_small_requests = true;
  VulkanEvaluator evaluator(options);
  const std::vector<Moments> expected = evaluator.evaluate(request, {});
  std::mt19937 random(5);
  const auto shuffle = [&](auto& list, auto member) {
    std::vector<std::uint32_t> order(list.size());
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(order.begin(), order.end(), random);
    auto moved = list;
    for (std::uint32_t i = 0; i < order.size(); ++i) moved[order[i]] = list[i];
    list = moved;
    for (MomentsEntry& entry : request.entries) entry.*member = order[entry.*member];
  };
  shuffle(request.theta_deg, &MomentsEntry::theta);
  shuffle(request.shapes, &MomentsEntry::shape);
  shuffle(request.indices, &MomentsEntry::index);
  std::vector<std::size_t> order(request.entries.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), random);
  const std::vector<MomentsEntry> entries = request.entries;
  for (std::size_t i = 0; i < order.size(); ++i) request.entries[i] = entries[order[i]];
  const std::vector<Moments> shuffled = evaluator.evaluate(request, {});
  for (std::size_t i = 0; i < order.size(); ++i) EXPECT_TRUE(same(shuffled[i], expected[order[i]])) << i;
}

std::string name_of_case(const testing::TestParamInfo<std::tuple<Masking, Precision>>& test) {
  constexpr std::array kNames = {"None", "VCavity", "Integral", "Smith"};
  return std::string(kNames[static_cast<std::size_t>(std::get<0>(test.param))]) +
         (std::get<1>(test.param) == Precision::kDouble ? "Double" : "Float");
}

INSTANTIATE_TEST_SUITE_P(Groups, GroupedKernel,
                         testing::Combine(testing::Values(Masking::kNone, Masking::kVCavity, Masking::kIntegral,
                                                          Masking::kSmith),
                                          testing::Values(Precision::kFloat, Precision::kDouble)),
                         name_of_case);

}  // namespace
}  // namespace dolp
