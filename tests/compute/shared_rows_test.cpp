// Entries of a grid share work: each is what it is alone, in whatever order the axes are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>

#include "properties_support.hpp"

namespace dolp {
namespace {

MomentsRequest grid(Masking masking, const std::vector<double>& theta_deg, const std::vector<double>& sigma,
                    const std::vector<double>& q, const std::vector<OpticalConstants>& indices) {
  MomentsRequest request;
  request.masking = masking;
  request.theta_deg = theta_deg;
  request.indices = indices;
  request.sigma = sigma;
  request.q = q;
  return request;
}

const std::vector<double> kManyQ = {2.6, 1.8, 2.0, 2.1, 1.7, 2.3, 2.5, 2.2, 3.0, 3.5, 4.0, 5.0};

bool same(const Moments& a, const Moments& b) {
  return std::tie(a.r_i, a.r_q, a.albedo, a.deficit, a.r_i_error, a.r_q_error, a.albedo_error, a.deficit_error,
                  a.evaluations) == std::tie(b.r_i, b.r_q, b.albedo, b.deficit, b.r_i_error, b.r_q_error,
                                             b.albedo_error, b.deficit_error, b.evaluations);
}

class RowKernel : public testing::TestWithParam<std::tuple<Masking, Precision>> {
 protected:
  /// A grid that is worth rows.
  MomentsRequest large_grid() const {
    const auto [masking, precision] = GetParam();
    std::vector<double> sigma;
    for (int i = 0; i < 48; ++i) sigma.push_back(0.02 * std::pow(50.0, i / 47.0));
    MomentsRequest request =
        grid(masking, {0.0, 20.0, 45.0, 70.0, 88.0, 89.9}, sigma, kManyQ, {{1.508, 0.0}, {27.0, 90.0}, {0.8, 0.0}});
    request.precision = precision;
    request.tolerance = precision == Precision::kDouble ? 1e-7 : 1e-4;
    return request;
  }
  VulkanOptions options() const {
    VulkanOptions validated;
    validated.precision = std::get<1>(GetParam());
    validated.validation = ValidationMode::kOn;
    return validated;
  }
};

// The members of a row have other nodes than each alone: both are right within their bounds.
TEST_P(RowKernel, Members_AgreeWithEachAloneWithinTheBounds) {
  const MomentsRequest request = large_grid();
  VulkanEvaluator evaluator(options());
  const std::vector<Moments> together = evaluator.evaluate(request, {});
  MomentsRequest points = request;
  points.theta_deg.clear();
  points.indices.clear();
  points.sigma.clear();
  points.q.clear();
  std::vector<std::size_t> positions;
  for (std::size_t i = 0; i < request.size(); i += 7) {
    points.append(request[i]);
    positions.push_back(i);
  }
  const std::vector<Moments> alone = evaluator.evaluate(points, {});
  double shared = 0.0, alone_evaluations = 0.0;
  for (std::size_t k = 0; k < alone.size(); ++k) {
    const Moments& a = alone[k];
    const Moments& b = together[positions[k]];
    expect_within_bounds(a, b, std::to_string(positions[k]));
    shared += b.evaluations;
    alone_evaluations += a.evaluations;
  }
  std::printf("evaluations: %.3g together, %.3g alone\n", shared, alone_evaluations);
  EXPECT_LT(shared, 1.01 * alone_evaluations);
}

// The order of the axes does not matter.
TEST_P(RowKernel, ShuffledAxes_KeepTheBitsOfEveryEntry) {
  const MomentsRequest request = large_grid();
  VulkanEvaluator evaluator(options());
  const std::vector<Moments> expected = evaluator.evaluate(request, {});
  std::mt19937 random(5);
  MomentsRequest other = request;
  std::ranges::shuffle(other.theta_deg, random);
  std::ranges::shuffle(other.indices, random);
  std::ranges::shuffle(other.sigma, random);
  std::ranges::shuffle(other.q, random);
  const std::vector<Moments> shuffled = evaluator.evaluate(other, {});
  const auto place = [](const auto& list, const auto& value) {
    return static_cast<std::size_t>(std::ranges::find(list, value) - list.begin());
  };
  for (std::size_t i = 0; i < other.size(); ++i) {
    const MomentsPoint point = other[i];
    const std::size_t direction = place(request.theta_deg, point.theta_deg) * request.indices.size();
    const std::size_t shapes = (direction + place(request.indices, point.index)) * request.sigma.size();
    const std::size_t j =
        (shapes + place(request.sigma, point.shape.sigma)) * request.q.size() + place(request.q, point.shape.q);
    ASSERT_TRUE(same(shuffled[i], expected[j])) << i;
  }
}

std::string name_of_case(const testing::TestParamInfo<std::tuple<Masking, Precision>>& test) {
  constexpr std::array kNames = {"None", "VCavity", "Integral", "Smith"};
  return std::string(kNames[static_cast<std::size_t>(std::get<0>(test.param))]) +
         (std::get<1>(test.param) == Precision::kDouble ? "Double" : "Float");
}

INSTANTIATE_TEST_SUITE_P(Rows, RowKernel,
                         testing::Combine(testing::Values(Masking::kNone, Masking::kVCavity, Masking::kIntegral,
                                                          Masking::kSmith),
                                          testing::Values(Precision::kFloat, Precision::kDouble)),
                         name_of_case);

}  // namespace
}  // namespace dolp
