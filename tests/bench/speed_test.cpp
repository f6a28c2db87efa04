// Tests of methods with which the benchmark compares: the kernel source compiled for the CPU, Gauss rules on the
// device.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "methods/method.hpp"
#include "methods/truth.hpp"
#include "model/choices.hpp"
#include "studies/cases.hpp"
#include "studies/grids.hpp"

namespace {

using namespace dolp;
using namespace dolp::bench;

constexpr std::array kMaskings = {Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith};
constexpr std::array kMaskingsByRows = {Masking::kIntegral, Masking::kSmith};

/// Without the zeniths 0 and 90 degrees, which some methods do not support.
MomentsRequest small_grid(Masking masking) {
  return steel_request(masking, axes_of({10.0, 40.0, 60.0, 80.0}, {0.05, 0.2, 0.5, 1.0}, {1.75, 3.0, 8.0}));
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

// The native build is compiled from the same kernel source as the kernels of the device. It may evaluate more nodes
// than the device, but not fewer.
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

// With 256 nodes per axis, the device needs several invocations for each entry.
TEST(BenchDeviceRule, ManyNodes_EveryMasking_GivesTheSumOfTheHost) {
  constexpr double kNodes = 256;
  constexpr double kRounding = 2e-5;  // the device rounds angles to float; the effect is largest for smooth surfaces
  const std::unique_ptr<Solver> device = solver_of("vulkan-gauss");
  const std::unique_ptr<Solver> host = solver_of("gauss");
  for (const Masking masking : kMaskings) {
    SCOPED_TRACE(name_of(masking));
    const MomentsRequest request = steel_request(masking, axes_of({20.0, 50.0, 75.0}, {0.3}, {2.5}));
    EXPECT_LE(largest_difference(device->solve(request, kNodes).answers, host->solve(request, kNodes).answers),
              kRounding);
  }
}

}  // namespace
