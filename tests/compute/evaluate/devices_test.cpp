// The choice of a Vulkan device from a list, and a real device under the validation layer.
#include <gtest/gtest.h>
#include <unistd.h>

#include <dolp/errors.hpp>
#include <new>
#include <string>
#include <vector>

#include "device/context.hpp"
#include "device/device.hpp"
#include "device/devices.hpp"
#include "device/result.hpp"
#include "error_text.hpp"
#include "failing_new.hpp"

namespace dolp::devices_test {
namespace {

dolp::Device described(std::string name, dolp::Device::Type type, bool usable, bool float64) {
  dolp::Device device;
  device.name = std::move(name);
  device.type = type;
  device.usable = usable;
  device.why_not = usable ? "" : "Vulkan 1.1.0 < 1.2";
  device.has_double = float64;
  return device;
}

std::vector<dolp::Device> five_devices() {
  using enum dolp::Device::Type;
  return {described("llvmpipe (LLVM 15)", kCpu, true, true), described("Iris Xe", kIntegrated, true, false),
          described("Old Radeon", kDiscrete, false, true), described("GeForce RTX 4090", kDiscrete, true, true),
          described("Radeon RX 7900", kDiscrete, true, true)};
}

TEST(ChooseDevice, Default_IsTheFirstUsableDiscreteGpu) {
  EXPECT_EQ(choose_device(five_devices(), "", false), 3U);
  std::vector<dolp::Device> devices = five_devices();
  devices.resize(3);
  EXPECT_EQ(choose_device(devices, "", false), 1U);
  EXPECT_EQ(choose_device(devices, "", true), 0U);
}

TEST(ChooseDevice, PositionOrPartOfTheName_IsThatDevice) {
  EXPECT_EQ(choose_device(five_devices(), "0", false), 0U);
  EXPECT_EQ(choose_device(five_devices(), "LLVMpipe", false), 0U);
  EXPECT_EQ(choose_device(five_devices(), "radeon", false), 4U);
  EXPECT_EQ(choose_device(five_devices(), "4090", false), 3U);
}

TEST(ChooseDevice, NoMatchOrUnfit_ThrowsWithTheReason) {
  const auto message = [](const std::string& choice, bool float64) -> std::string {
    return error_text<DeviceError>([&] { choose_device(five_devices(), choice, float64); });
  };
  EXPECT_NE(message("voodoo", false).find("'voodoo'; devices: 0 = llvmpipe (LLVM 15), 1 = Iris Xe"), std::string::npos);
  EXPECT_NE(message("6", false).find("no Vulkan device matches '6'"), std::string::npos);
  EXPECT_NE(message("2", false).find("Vulkan 1.1.0 < 1.2"), std::string::npos);
  EXPECT_NE(message("iris", true).find("shaderFloat64"), std::string::npos);
}

TEST(ChooseQueueFamily, ComputeWithoutGraphics_IsPreferred) {
  constexpr VkQueueFlags kGraphics = VK_QUEUE_GRAPHICS_BIT, kCompute = VK_QUEUE_COMPUTE_BIT;
  const auto chosen = [](const std::vector<VkQueueFlags>& flags) {
    std::vector<VkQueueFamilyProperties> families;
    for (const VkQueueFlags family : flags) families.push_back({.queueFlags = family, .queueCount = 1});
    return vulkan::choose_queue_family(families);
  };
  EXPECT_EQ(chosen({kGraphics | kCompute | VK_QUEUE_TRANSFER_BIT, VK_QUEUE_TRANSFER_BIT, kCompute}), 2U);
  EXPECT_EQ(chosen({kCompute | VK_QUEUE_TRANSFER_BIT, kGraphics | kCompute, kCompute}), 0U);
  EXPECT_EQ(chosen({VK_QUEUE_TRANSFER_BIT, kGraphics, kGraphics | kCompute, kGraphics | kCompute}), 2U);
  EXPECT_EQ(chosen({VK_QUEUE_TRANSFER_BIT, kGraphics}), std::nullopt);
  EXPECT_EQ(chosen({}), std::nullopt);
}

const DeviceSelector kWatched{.has_validation = true};

TEST(VulkanContext, WorkgroupOnAProcessor_IsAVector) {
  const vulkan::Context context(kWatched);
  const dolp::Device& device = context.description();
  const bool is_processor = device.type == dolp::Device::Type::kCpu;
  EXPECT_EQ(device.local_size, is_processor ? device.subgroup_size : 64U);
  EXPECT_EQ(context.device().local_size(), device.local_size);
  EXPECT_TRUE(context.validation_messages().empty()) << context.validation_messages().front();
}

TEST(LacksThreads, NoMemoryForOneOfThem_Ends) {
  constexpr unsigned kLongest_s = 60;  // ends the test if lacks_threads() waits forever
  ::alarm(kLongest_s);
  EXPECT_FALSE(vulkan::lacks_threads());
  int refused = 0;
  bool has_failed = true;
  for (long before = 0; has_failed; ++before) {
    const FailingNew failing(before);
    try {
      vulkan::lacks_threads();
    } catch (const std::bad_alloc&) {
      ++refused;
    }
    has_failed = failing.has_failed();
  }
  EXPECT_GT(refused, 3);
  ::alarm(0);
}

}  // namespace
}  // namespace dolp::devices_test
