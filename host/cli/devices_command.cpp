#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "error.hpp"
#include "evaluate/vulkan/devices.hpp"

namespace dolp::cli {
namespace {

constexpr double kMebibyte = 1048576.0;

nlohmann::ordered_json device_json(const DeviceDescription& device, std::size_t position) {
  return {{"index", position},
          {"name", device.name},
          {"type", type_name(device.type)},
          {"driver", device.driver},
          {"api_version", device.api_version},
          {"usable", device.usable},
          {"why_not", device.why_not},
          {"float64", device.float64},
          {"max_storage_buffer_bytes", device.max_storage_buffer_bytes},
          {"max_workgroups", device.max_workgroups},
          {"heap_bytes", device.heap_bytes},
          {"subgroup_size", device.subgroup_size},
          {"timestamps", device.timestamps}};
}

std::string device_text(const DeviceDescription& device, std::size_t position) {
  return fmt::format(
      "{}: {} ({})\n   {}, Vulkan {}\n   {}\n   double precision {}, storage buffer {:.0f} MiB, heap {:.0f} MiB, {} "
      "workgroups, subgroup {}, timestamps {}\n",
      position, device.name, type_name(device.type), device.driver, device.api_version,
      device.usable ? "usable" : "not usable: " + device.why_not, device.float64 ? "yes" : "no",
      static_cast<double>(device.max_storage_buffer_bytes) / kMebibyte,
      static_cast<double>(device.heap_bytes) / kMebibyte, device.max_workgroups, device.subgroup_size,
      device.timestamps ? "yes" : "no");
}

}  // namespace

int run_devices(const Options& options) {
  const DeviceList list = list_devices();
  if (options.json) {
    nlohmann::ordered_json json = {{"devices", nlohmann::ordered_json::array()}, {"why_empty", list.why_empty}};
    for (std::size_t i = 0; i < list.devices.size(); ++i) json["devices"].push_back(device_json(list.devices[i], i));
    fmt::print("{}\n", json.dump(2));
  } else {
    for (std::size_t i = 0; i < list.devices.size(); ++i) fmt::print("{}", device_text(list.devices[i], i));
  }
  if (list.devices.empty()) throw DeviceError(list.why_empty);
  choose_device(list.devices, options.device, false);  // says why when no device can be used
  return kExitDone;
}

}  // namespace dolp::cli
