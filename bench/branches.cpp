#include "bench/branches.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/bench_device.hpp"
#include "evaluate/vulkan/moments_run.hpp"
#include "shaders/spirv.hpp"

namespace dolp::bench {
namespace {

constexpr double kTimeout = 600.0;  // seconds for one dispatch
constexpr std::uint32_t kTile = 1U << 16U;
constexpr std::uint32_t kBlockShapes = 1U << 12U;

double largest_difference(const std::vector<Moments>& a, const std::vector<Moments>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double difference = std::max(std::abs(a[i].r_i - b[i].r_i), std::abs(a[i].r_q - b[i].r_q));
    largest =
        std::isnan(difference) ? std::numeric_limits<double>::infinity() : std::max(largest, difference / a[i].r_i);
  }
  return largest;
}

}  // namespace

struct BranchComparison::Impl {
  explicit Impl(const std::string& choice)
      : bench(choice), specialised(bench.device, false), uniform(bench.device, false) {}

  struct Run {
    std::vector<Moments> moments;
    double kernel_s = 0.0;
  };
  Run run(vulkan::Kernels& kernels, const MomentsRequest& request) {
    vulkan::MomentsRun moments_run({.device = bench.device,
                                    .kernels = kernels,
                                    .stream = bench.stream,
                                    .packing = vulkan::Packing(false),
                                    .tile_timeout_s = kTimeout},
                                   request, kTile, kBlockShapes);
    Run result;
    result.moments = moments_run.compute(nullptr).value();
    result.kernel_s = moments_run.cost().kernel_s;
    bench.check_messages();
    return result;
  }

  BenchDevice bench;
  vulkan::Kernels specialised, uniform;
};

BranchComparison::BranchComparison(const std::string& device) : impl_(std::make_unique<Impl>(device)) {}

BranchComparison::~BranchComparison() = default;

BranchTimes BranchComparison::compare(const MomentsRequest& request, std::size_t repeats) {
  impl_->uniform.replace_moments(
      request.distribution, request.masking,
      impl_->uniform.create(spirv::moments_uniform_float, request.distribution, request.masking));
  BranchTimes times;
  times.error =
      largest_difference(impl_->run(impl_->specialised, request).moments, impl_->run(impl_->uniform, request).moments);
  for (std::size_t i = 0; i < repeats; ++i) {
    times.specialised_s.push_back(impl_->run(impl_->specialised, request).kernel_s);
    times.uniform_s.push_back(impl_->run(impl_->uniform, request).kernel_s);
  }
  return times;
}

}  // namespace dolp::bench
