#include "bench/branches.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string_view>

#include "error.hpp"
#include "evaluate/vulkan/instance.hpp"
#include "evaluate/vulkan/moments_run.hpp"
#include "shaders/spirv.hpp"

namespace dolp::bench {
namespace {

constexpr double kTimeout = 600.0;  // seconds for one dispatch
constexpr std::uint32_t kTile = 1U << 16U;
constexpr std::uint32_t kBlockShapes = 1U << 12U;

bool wants_validation() {
  const char* value = std::getenv("DOLP_VALIDATION");
  return value != nullptr && std::string_view(value) == "1";
}

VkPhysicalDevice chosen(const vulkan::Instance& instance, const std::string& choice) {
  const std::vector<VkPhysicalDevice> all = instance.physical_devices();
  std::vector<DeviceDescription> descriptions;
  for (VkPhysicalDevice device : all) descriptions.push_back(vulkan::describe(device));
  return all[choose_device(descriptions, choice, false)];
}

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
      : instance(wants_validation() ? &log : nullptr),
        device(chosen(instance, choice), false),
        specialised(device, false),
        uniform(device, false),
        stream(device) {}

  struct Run {
    std::vector<Moments> moments;
    double kernel_s = 0.0;
  };
  Run run(vulkan::Kernels& kernels, const MomentsRequest& request) {
    vulkan::MomentsRun moments_run({.device = device,
                                    .kernels = kernels,
                                    .stream = stream,
                                    .packing = vulkan::Packing(false),
                                    .tile_timeout_s = kTimeout},
                                   request, kTile, kBlockShapes);
    Run result;
    result.moments = moments_run.compute(nullptr).value();
    result.kernel_s = moments_run.cost().kernel_s;
    const std::vector<std::string> messages = log.messages();
    if (!messages.empty()) throw DeviceError("Vulkan validation: " + messages.front());
    return result;
  }

  vulkan::ValidationLog log;
  vulkan::Instance instance;
  vulkan::Device device;
  vulkan::Kernels specialised, uniform;
  vulkan::CommandStream stream;
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
