// What the studies of speed rest on: nested grids, the native and the counting build of the text, the device's peak.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/arithmetic_peak.hpp"
#include "bench/cases.hpp"
#include "bench/grids.hpp"
#include "bench/method.hpp"
#include "bench/operations.hpp"
#include "bench/truth.hpp"
#include "model/choices.hpp"

namespace {

using namespace dolp;
using namespace dolp::bench;

constexpr std::array kMaskings = {Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith};
constexpr std::array kMaskingsByRows = {Masking::kIntegral, Masking::kSmith};

MomentsRequest small_grid(Masking masking) {
  return steel_request(masking, NestedGrid::with_stride(NestedGrid::kLargestStride));
}

std::unique_ptr<Solver> solver_of(const std::string& name) {
  return std::ranges::find(methods(), name, &Method::name)->make({});
}

double largest_difference(const std::vector<Answer>& a, const std::vector<Answer>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max({largest, std::abs(a[i].r_i - b[i].r_i) / b[i].r_i, std::abs(a[i].r_q - b[i].r_q) / b[i].r_i});
  }
  return largest;
}

TEST(BenchGrids, NestedGrid_SampleInEveryStride_IsTheSameEntry) {
  constexpr std::size_t kSample = 20;
  const std::vector<NestedGrid::Place> places = NestedGrid::sample(kSample);
  const MomentsRequest alone = sample_request(Masking::kNone, places);
  for (std::size_t stride = 1; stride <= NestedGrid::kLargestStride; stride *= 2) {
    SCOPED_TRACE(stride);
    const MomentsRequest grid = steel_request(Masking::kNone, NestedGrid::with_stride(stride));
    ASSERT_EQ(grid.size(), std::pow(NestedGrid::kSide / stride, 3));
    for (std::size_t i = 0; i < kSample; ++i) {
      EXPECT_EQ(grid[places[i].position(stride)], alone[i]);
    }
  }
}

TEST(BenchGrids, SteelGrid_Axes_AreThoseOfTheScene) {
  const Grid grid = steel_grid({91, 32, 5});
  EXPECT_EQ(grid.theta_deg.front(), 0.0);
  EXPECT_EQ(grid.theta_deg.back(), 90.0);
  EXPECT_DOUBLE_EQ(grid.sigma.front(), 0.05);
  EXPECT_DOUBLE_EQ(grid.sigma.back(), 1.0);
  EXPECT_DOUBLE_EQ(grid.q.front(), 1.75);
  EXPECT_DOUBLE_EQ(grid.q.back(), 8.0);
  EXPECT_EQ(GridSize({91, 32, 5}).text(), "91 x 32 x 5");
}

// Nobody beside it with other orders: what differs is the rounding.
TEST(BenchNative, OneDirection_HasTheNodesAndMomentsOfTheDevice) {
  constexpr double kRounding = 1e-5;
  const std::unique_ptr<Solver> native = solver_of("native-float");
  const std::unique_ptr<Solver> device = solver_of("vulkan-float");
  for (const Masking masking : kMaskingsByRows) {
    SCOPED_TRACE(name_of(masking));
    Grid grid = NestedGrid::with_stride(NestedGrid::kLargestStride);
    grid.theta_deg = {grid.theta_deg[5]};
    const MomentsRequest request = steel_request(masking, grid);
    const Solution ours = native->solve(request, 1e-4);
    const Solution theirs = device->solve(request, 1e-4);
    EXPECT_LE(largest_difference(ours.answers, theirs.answers), kRounding);
    EXPECT_NEAR(*ours.evaluations / *theirs.evaluations, 1.0, 1e-3);
  }
}

// Directions side by side take the largest of their orders, which on this coarse grid are far apart.
TEST(BenchNative, Grid_HasTheDevicesNodesOrMoreAndItsMoments) {
  constexpr double kTolerance = 1e-4;
  const std::unique_ptr<Solver> native = solver_of("native-float");
  const std::unique_ptr<Solver> device = solver_of("vulkan-float");
  for (const Masking masking : kMaskingsByRows) {
    SCOPED_TRACE(name_of(masking));
    const MomentsRequest request = small_grid(masking);
    const Solution ours = native->solve(request, kTolerance);
    const Solution theirs = device->solve(request, kTolerance);
    EXPECT_LE(largest_difference(ours.answers, theirs.answers), kTolerance);
    EXPECT_GE(*ours.evaluations / *theirs.evaluations, 0.999);
    EXPECT_LE(*ours.evaluations / *theirs.evaluations, 4.0);
    EXPECT_GT(*ours.kernel_s, 0.0);
  }
}

TEST(BenchNative, GaussianDistributionOrProfiles_AreUnavailable) {
  MomentsRequest request = small_grid(Masking::kSmith);
  request.distribution = Distribution::kGaussian;
  EXPECT_THROW(solver_of("native-float")->solve(request, 1e-4), Unavailable);
  EXPECT_THROW(solver_of("native-float")->solve(small_grid(Masking::kNone), 1e-4), Unavailable);
}

// So many nodes that an entry is spread over several invocations.
TEST(BenchDeviceRule, ManyNodes_EveryMasking_GivesTheSumOfTheHost) {
  constexpr double kNodes = 256;
  constexpr double kRounding = 2e-5;  // of geometry in float, on the smoothest surface
  const std::vector<NestedGrid::Place> places = NestedGrid::sample(3);
  const std::unique_ptr<Solver> device = solver_of("vulkan-gauss");
  const std::unique_ptr<Solver> host = solver_of("gauss");
  for (const Masking masking : kMaskings) {
    SCOPED_TRACE(name_of(masking));
    const MomentsRequest request = sample_request(masking, places);
    EXPECT_LE(largest_difference(device->solve(request, kNodes).answers, host->solve(request, kNodes).answers),
              kRounding);
  }
}

TEST(BenchOperations, WholeRequest_CountsWhatTheKernelDoes) {
  const MomentsRequest request = small_grid(Masking::kIntegral);
  const KernelWork work = count_operations(request, 1'000'000, 8);
  const Solution solution = solver_of("vulkan-float")->solve(request, request.tolerance);
  EXPECT_NEAR(work.evaluations / *solution.evaluations, 1.0, 1e-3);
  // 3 square roots a sample, and those of the pieces; Fresnel alone takes about 40 multiplications.
  EXPECT_GT(static_cast<double>(work.counts.square_root), 3.0 * work.evaluations);
  EXPECT_GT(static_cast<double>(work.counts.multiply), 40.0 * work.evaluations);
  EXPECT_LT(static_cast<double>(work.counts.flops()), 5000.0 * work.evaluations);
  EXPECT_GT(work.counts.add, work.counts.divide);
  EXPECT_GT(work.busy_lanes, 0.2);
  EXPECT_LT(work.busy_lanes, 1.0);
}

TEST(BenchOperations, MaskingTable_BelongsToTheWork) {
  const auto flops_each = [](const Grid& grid) {
    const KernelWork work = count_operations(steel_request(Masking::kSmith, grid), 1'000, 8);
    return static_cast<double>(work.counts.flops()) / work.evaluations;
  };
  const Grid all = NestedGrid::with_stride(NestedGrid::kLargestStride);
  Grid one = all;
  one.theta_deg = {all.theta_deg[5]};
  EXPECT_GT(flops_each(one), 1.1 * flops_each(all));
}

TEST(BenchOperations, Sample_IsCloseToTheWhole_OneLaneIsAlwaysBusy) {
  constexpr double kSampling = 0.2;
  const MomentsRequest request = steel_request(Masking::kSmith, NestedGrid::with_stride(4));
  const KernelWork whole = count_operations(request, 1'000'000, 1);
  const KernelWork sample = count_operations(request, 20, 1);
  EXPECT_NEAR(static_cast<double>(sample.counts.flops()) / static_cast<double>(whole.counts.flops()), 1.0, kSampling);
  EXPECT_DOUBLE_EQ(whole.busy_lanes, 1.0);
}

TEST(BenchPeak, Device_Rates_AreSorted) {
  const std::vector<double> rates = arithmetic_peak("", 3);
  ASSERT_EQ(rates.size(), 3U);
  EXPECT_TRUE(std::ranges::is_sorted(rates));
  EXPECT_GT(rates.front(), 0.0);
}

TEST(BenchTruth, Sample_BoundsAreTight_ErrorIsRelative) {
  const MomentsRequest request = sample_request(Masking::kVCavity, NestedGrid::sample(2));
  const std::vector<Truth> truths = truths_of(request);
  ASSERT_EQ(truths.size(), 2U);
  const Moments& first = truths.front().moments;
  EXPECT_LE(truths.front().bound, 1e-11);
  EXPECT_EQ(error_of({first.r_i, first.r_q, {}}, truths.front()), 0.0);
  EXPECT_NEAR(error_of({first.r_i, first.r_q + 1e-3 * first.r_i, {}}, truths.front()), 1e-3, 1e-12);
}

}  // namespace
