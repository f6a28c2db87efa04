// One device that several evaluators use from their own threads, as the window has them, under the validation layer.
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "base/error.hpp"
#include "evaluate/vulkan/context.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"

namespace dolp {
namespace {

// Enough submissions that two threads meet at the queue.
constexpr std::uint32_t kTileInvocations = 4;
constexpr int kRepeats = 4;

VulkanOptions options_of_window() {
  VulkanOptions options;
  options.precision = Precision::kFloat;
  options.validation = ValidationMode::kOn;
  options.max_tile_invocations = kTileInvocations;
  return options;
}

MomentsRequest request_of(Masking masking) {
  MomentsRequest request;
  request.masking = masking;
  for (int i = 0; i < 40; ++i) request.append({2.0 * i, {0.1 + 0.01 * i, 3.0}, {1.5, 0.1}});
  return request;
}

std::vector<double> values_of(VulkanEvaluator& evaluator, Masking masking) {
  std::vector<double> values;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    for (const Moments& moments : evaluator.evaluate(request_of(masking), {})) values.push_back(moments.r_q);
  }
  return values;
}

TEST(VulkanContext, TwoThreads_GetTheResultsOfOneAloneWithoutAValidationMessage) {
  const VulkanOptions options = options_of_window();
  vulkan::Context context(options);
  VulkanEvaluator first(context, options);
  VulkanEvaluator second(context, options);
  std::vector<double> of_first;
  std::vector<double> of_second;
  {
    const std::jthread one([&] { of_first = values_of(first, Masking::kNone); });
    const std::jthread two([&] { of_second = values_of(second, Masking::kVCavity); });
  }
  VulkanEvaluator alone(options);
  EXPECT_EQ(of_first, values_of(alone, Masking::kNone));
  EXPECT_EQ(of_second, values_of(alone, Masking::kVCavity));
  EXPECT_TRUE(context.validation_messages().empty()) << context.validation_messages().front();
}

TEST(VulkanContext, WorkgroupOnAProcessor_IsAVector) {
  const vulkan::Context context(options_of_window());
  const DeviceDescription& device = context.description();
  const bool is_processor = device.type == DeviceDescription::Type::kCpu;
  EXPECT_EQ(device.local_size, is_processor ? device.subgroup_size : 64U);
  EXPECT_EQ(context.device().local_size(), device.local_size);
}

TEST(VulkanContext, NothingCanPresent_NamesTheDeviceAndSaysWhy) {
  const vulkan::Presentation nowhere{{}, [](VkInstance, VkPhysicalDevice, std::uint32_t) { return false; }};
  try {
    const vulkan::Context context(options_of_window(), &nowhere);
    FAIL() << "a window without a display";
  } catch (const DeviceError& error) {
    EXPECT_NE(std::string(error.what()).find("cannot show a window on this display"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace dolp
