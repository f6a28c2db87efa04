// The choice of a device, under the validation layer.
#include <gtest/gtest.h>
#include <dolp/errors.hpp>

#include "device/context.hpp"

namespace dolp {
namespace {

const DeviceSelector kWatched{.validation = ValidationMode::kOn};

TEST(VulkanContext, WorkgroupOnAProcessor_IsAVector) {
  const vulkan::Context context(kWatched);
  const dolp::Device& device = context.description();
  const bool is_processor = device.type == dolp::Device::Type::kCpu;
  EXPECT_EQ(device.local_size, is_processor ? device.subgroup_size : 64U);
  EXPECT_EQ(context.device().local_size(), device.local_size);
  EXPECT_TRUE(context.validation_messages().empty()) << context.validation_messages().front();
}

TEST(VulkanContext, NothingCanPresent_NamesTheDeviceAndSaysWhy) {
  const vulkan::Presentation nowhere{{}, [](VkInstance, VkPhysicalDevice, std::uint32_t) { return false; }};
  try {
    const vulkan::Context context(kWatched, &nowhere);
    FAIL() << "a window without a display";
  } catch (const DeviceError& error) {
    EXPECT_NE(std::string(error.what()).find("cannot show a window on this display"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace dolp
