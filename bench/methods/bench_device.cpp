#include "methods/bench_device.hpp"

#include <cstdlib>
#include <dolp/errors.hpp>
#include <string_view>
#include <vector>

namespace dolp::bench {
namespace {

bool wants_validation() {
  const char* value = std::getenv("DOLP_VALIDATION");
  return value != nullptr && std::string_view(value) == "1";
}

}  // namespace

VkPhysicalDevice chosen_device(const vulkan::Instance& instance, const std::string& choice) {
  const std::vector<VkPhysicalDevice> all = instance.physical_devices();
  std::vector<dolp::Device> descriptions;
  for (VkPhysicalDevice device : all) descriptions.push_back(vulkan::describe(device));
  return all[choose_device(descriptions, choice, false)];
}

BenchDevice::BenchDevice(const std::string& choice)
    : instance(wants_validation() ? &log : nullptr),
      physical(chosen_device(instance, choice)),
      device(physical, {}),
      stream(device) {}

std::string BenchDevice::where() const {
  const dolp::Device description = vulkan::describe(physical);
  return description.name + ", " + description.driver;
}

void BenchDevice::check_messages() const {
  const std::vector<std::string> messages = log.messages();
  if (!messages.empty()) throw DeviceError("Vulkan validation: " + messages.front());
}

}  // namespace dolp::bench
