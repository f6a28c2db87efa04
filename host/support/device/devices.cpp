#include "device/devices.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "base/text.hpp"
#include "device/context.hpp"
#include "device/device.hpp"
#include "device/result.hpp"

namespace dolp {
namespace {

std::optional<std::size_t> position(const std::string& choice, std::size_t count) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(choice.data(), choice.data() + choice.size(), index);
  if (error != std::errc{} || end != choice.data() + choice.size() || index >= count) return std::nullopt;
  return index;
}

std::string listing(const std::vector<Device>& devices) {
  if (devices.empty()) return "there is no device";
  std::string text = "devices:";
  for (std::size_t i = 0; i < devices.size(); ++i) {
    text += (i > 0 ? ", " : " ") + std::to_string(i) + " = " + devices[i].name;
    if (!devices[i].usable) text += " (not usable: " + devices[i].why_not + ')';
  }
  return text;
}

}  // namespace

std::string type_name(Device::Type type) {
  constexpr std::array kNames = {"discrete GPU", "integrated GPU", "virtual GPU", "CPU", "other"};
  return kNames[static_cast<std::size_t>(type)];
}

DeviceList list_devices() {
  DeviceList list;
  try {
    const vulkan::Instance instance(nullptr);
    for (VkPhysicalDevice physical : instance.physical_devices()) list.devices.push_back(vulkan::describe(physical));
  } catch (const DeviceError& error) {
    list.why_empty = error.what();
  }
  return list;
}

std::size_t choose_device(const std::vector<Device>& devices, const std::string& choice, bool float64) {
  std::vector<std::size_t> candidates;
  if (const auto index = position(choice, devices.size())) {
    candidates.push_back(*index);
  } else {
    for (std::size_t i = 0; i < devices.size(); ++i) {
      if (lower_case(devices[i].name).find(lower_case(choice)) != std::string::npos) candidates.push_back(i);
    }
  }
  if (candidates.empty()) throw DeviceError("no Vulkan device matches '" + choice + "'; " + listing(devices));
  std::erase_if(candidates, [&](std::size_t i) { return !devices[i].usable; });
  if (candidates.empty()) throw DeviceError("the Vulkan device is not usable; " + listing(devices));
  std::erase_if(candidates, [&](std::size_t i) { return float64 && !devices[i].has_double; });
  if (candidates.empty()) {
    throw DeviceError("the Vulkan device has no double precision (shaderFloat64), use float; " + listing(devices));
  }
  return *std::ranges::min_element(candidates, {}, [&](std::size_t i) { return devices[i].type; });
}

std::vector<Device> devices() { return list_devices().devices; }

void require_device(const std::string& device) {
  const DeviceList list = list_devices();
  if (list.devices.empty()) throw DeviceError(list.why_empty);
  choose_device(list.devices, device, false);  // throws if no usable device matches
}

}  // namespace dolp
