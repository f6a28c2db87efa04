// Rows of entries that differ in q alone: who shares one, and that the kernel says the same of each alone.
#include "plan/rows.hpp"

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

/// How often a row has each entry.
std::vector<int> times_in_rows(const Rows& rows, const KernelData& data) {
  std::vector<int> times(data.size(), 0);
  for (const Row& row : rows.rows) {
    const Chunk& chunk = rows.chunks.at(row.chunk);
    for (std::uint32_t g = 0; g < chunk.count; ++g) {
      ++times.at(data.entry_of(row.direction, row.index, rows.shape_of.at(chunk.first + g)));
    }
  }
  return times;
}

TEST(RowsOf, Grid_HasEveryEntryOnceUnderItsOwnDirectionIndexAndShape) {
  const MomentsRequest request =
      grid(Masking::kIntegral, {0.0, 30.0, 60.0}, {0.3, 0.1}, kManyQ, {{1.5, 0.0}, {0.9, 0.0}});
  const KernelData data = kernel_data(request);
  for (const std::uint32_t width : kRowWidths) {
    const Rows rows = rows_of(request, data, width);
    EXPECT_EQ(times_in_rows(rows, data), std::vector<int>(request.size(), 1));
    for (const Chunk& chunk : rows.chunks) EXPECT_LE(chunk.count, width);
    for (std::size_t i = 0; i < rows.shapes.size(); ++i) {
      const kernel::ShapeNode& own = data.shapes[rows.shape_of[i]];
      EXPECT_EQ(rows.shapes[i].m, own.m);
      EXPECT_EQ(rows.shapes[i].q_minus_1, own.q_minus_1);
      EXPECT_EQ(rows.shapes[i].marginal_norm, own.marginal_norm);
    }
  }
}

TEST(RowsOf, EntryPositions_AreThoseOfTheRequest) {
  const MomentsRequest request =
      grid(Masking::kIntegral, {0.0, 30.0, 60.0}, {0.3, 0.1}, {1.7, 40.0}, {{1.5, 0.0}, {0.9, 0.0}, {0.8, 0.0}});
  const KernelData data = kernel_data(request);
  ASSERT_EQ(data.size(), request.size());
  for (std::size_t i = 0; i < request.size(); ++i) {
    const MomentsPoint point = request[i];
    const MomentsEntry entry = data[i];
    EXPECT_EQ(data.shapes[entry.shape].q_minus_1, point.shape.q - 1.0);
    EXPECT_EQ(data.shapes[entry.shape].m, slope_width(point.shape));
    EXPECT_EQ(request.indices[entry.index], point.index);
    EXPECT_NEAR(data.thetas[entry.theta].s, std::sin(point.theta_deg * 3.14159265358979 / 180.0), 1e-14);
    EXPECT_EQ(data.pieces[entry.theta].has_split_line, data.needs_line[entry.shape] != 0);
  }
}

TEST(RowsOf, Mask_LeavesOutRowsOfWhichNothingIsWanted) {
  MomentsRequest request = grid(Masking::kIntegral, {0.0, 30.0, 60.0}, {0.3, 0.1}, kManyQ, {{1.5, 0.0}, {0.9, 0.0}});
  request.wanted.assign(request.size(), 0);
  for (const std::size_t i : {0U, 5U, 29U, 100U}) request.wanted[i] = 1;
  const KernelData data = kernel_data(request);
  for (const std::uint32_t width : kRowWidths) {
    const Rows rows = rows_of(request, data, width);
    const std::vector<int> times = times_in_rows(rows, data);
    for (std::size_t i = 0; i < times.size(); ++i) {
      EXPECT_LE(times[i], 1);
      if (request.wanted[i] != 0) {
        EXPECT_EQ(times[i], 1) << i;
      }
    }
    std::uint32_t used = 0;
    for (const Row& row : rows.rows) {
      EXPECT_GT(row.used, 0U);
      used += row.used;
    }
    EXPECT_EQ(used, 4U);
  }
}

TEST(RowsOf, Chunks_ShareTheHardestNeedsAndAscendInQ) {
  const MomentsRequest request = grid(Masking::kSmith, {30.0}, {0.05, 0.9}, kManyQ, {{1.5, 0.0}});
  const KernelData data = kernel_data(request);
  const Rows rows = rows_of(request, data, 8);
  double widest = 0.0;
  for (const Chunk& chunk : rows.chunks) {
    const kernel::ShapeNode& first = rows.shapes[chunk.first];
    for (std::uint32_t g = 0; g < chunk.count; ++g) {
      const kernel::ShapeNode& shape = rows.shapes[chunk.first + g];
      const kernel::ShapeNode& own = data.shapes[rows.shape_of[chunk.first + g]];
      EXPECT_EQ(shape.m, first.m);
      if (g > 0) {
        EXPECT_GT(shape.q_minus_1, rows.shapes[chunk.first + g - 1].q_minus_1);
      }
      EXPECT_EQ(std::tie(shape.scale, shape.cut, shape.table_scale, shape.cusp_digits),
                std::tie(first.scale, first.cut, first.table_scale, first.cusp_digits));
      EXPECT_LE(first.scale, own.scale);
      EXPECT_GE(first.cut, own.cut);
      EXPECT_GE(first.cusp_digits, own.cusp_digits);
      widest = std::max(widest, shape.q_minus_1 / first.q_minus_1);
    }
  }
  EXPECT_GT(widest, 1.5);
}

TEST(RowsOf, Neighbours_DifferInTheDirection) {
  const MomentsRequest request = grid(Masking::kNone, {10.0, 20.0, 40.0}, {0.1, 0.2}, kManyQ, {{1.5, 0.0}, {2.0, 1.0}});
  const KernelData data = kernel_data(request);
  const Rows rows = rows_of(request, data, 8);
  const std::vector<RowPiece> pieces = pieces_of(rows, data, 0, static_cast<std::uint32_t>(rows.rows.size()));
  std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
  std::size_t alike = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    EXPECT_TRUE(seen.emplace(pieces[i].row, pieces[i].piece).second);
    if (i == 0) continue;
    const Row& row = rows.rows[pieces[i].row];
    const Row& before = rows.rows[pieces[i - 1].row];
    alike += row.chunk == before.chunk && row.index == before.index && pieces[i].piece == pieces[i - 1].piece ? 1 : 0;
  }
  EXPECT_GE(3 * (alike + 1), pieces.size());
}

TEST(RowsOf, EntriesThatShareNothing_AreAlone) {
  MomentsRequest request = grid(Masking::kNone, {10.0, 20.0, 40.0}, {0.1, 0.2, 0.4}, {2.0}, {{1.5, 0.0}});
  EXPECT_EQ(rows_of(request, kernel_data(request)).width, 1U);
  request = grid(Masking::kNone, {10.0}, {0.1}, kManyQ, {{1.5, 0.0}});
  request.distribution = Distribution::kGaussian;  // which has no q
  for (const Chunk& chunk : rows_of(request, kernel_data(request), 8).chunks) EXPECT_EQ(chunk.count, 1U);
}

TEST(RowsOf, Points_AreRowsOfOneAndNeighboursShareTheirShape) {
  MomentsRequest request;
  request.append({10.0, {0.1, 2.0}, {1.5, 0.0}});
  request.append({20.0, {0.1, 2.0}, {1.6, 0.0}});
  request.append({10.0, {0.2, 2.0}, {1.5, 0.0}});
  const KernelData data = kernel_data(request);
  const Rows rows = rows_of(request, data);
  EXPECT_EQ(rows.width, 1U);
  EXPECT_EQ(rows.shapes.size(), 2U);
  EXPECT_EQ(times_in_rows(rows, data), std::vector<int>(3, 1));
}

TEST(RowsOf, SmallRequest_IsNotWorthAKernelOfItsOwn) {
  const std::vector<double> theta_deg = {5.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0};
  MomentsRequest request = grid(Masking::kNone, theta_deg, {0.1, 0.2}, kManyQ, {{1.5, 0.0}});
  EXPECT_EQ(rows_of(request, kernel_data(request)).width, 1U);
  for (std::uint32_t i = 1; i < 400; ++i) request.indices.push_back({1.5 + 0.01 * i, 0.0});
  EXPECT_GT(rows_of(request, kernel_data(request)).width, 1U);
}

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
  const auto [masking, precision] = GetParam();
  const MomentsRequest request = large_grid();
  const bool shares = rows_of(request, kernel_data(request)).width > 1;
  EXPECT_TRUE(shares || (masking == Masking::kSmith && precision == Precision::kDouble));
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
    EXPECT_LE(std::abs(a.r_i - b.r_i), a.r_i_error + b.r_i_error) << positions[k];
    EXPECT_LE(std::abs(a.r_q - b.r_q), a.r_q_error + b.r_q_error) << positions[k];
    EXPECT_LE(std::abs(a.albedo - b.albedo), a.albedo_error + b.albedo_error) << positions[k];
    EXPECT_LE(std::abs(a.deficit - b.deficit), a.deficit_error + b.deficit_error) << positions[k];
    shared += b.evaluations;
    alone_evaluations += a.evaluations;
  }
  std::printf("evaluations: %.3g together, %.3g alone\n", shared, alone_evaluations);
  EXPECT_LT(shared, shares ? 0.6 * alone_evaluations : 1.01 * alone_evaluations);
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
