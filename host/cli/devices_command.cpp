#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "cli/commands.hpp"
#include "evaluate/vulkan/devices.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "terminal/exit_status.hpp"
#include "verify/qualification.hpp"

namespace dolp::cli {
namespace {

constexpr double kMebibyte = 1048576.0;
// What each arithmetic is asked for: near the best that it can do.
constexpr double kFloatTolerance = 1e-6;
constexpr double kDoubleTolerance = 1e-9;

/// How well a device computes in one precision, or why that is not known.
struct Quality {
  const char* precision;
  std::optional<DeviceQuality> measured;
  std::string why_not;
};

Quality quality_in(const DeviceDescription& device, std::size_t position, Precision precision) {
  const bool in_double = precision == Precision::kDouble;
  Quality quality{in_double ? "double" : "float", {}, {}};
  if (!device.usable) quality.why_not = "the device is not usable";
  if (in_double && !device.float64) quality.why_not = "the device has no double precision (shaderFloat64)";
  if (!quality.why_not.empty()) return quality;
  try {
    VulkanOptions options;
    options.device = std::to_string(position);
    options.precision = precision;
    VulkanEvaluator evaluator(options);
    quality.measured = measure_quality(evaluator, in_double ? kDoubleTolerance : kFloatTolerance);
  } catch (const DeviceError& error) {
    quality.why_not = error.what();
  }
  return quality;
}

std::string quality_text(const Quality& quality) {
  if (!quality.measured) return fmt::format("   {:<6} not measured: {}\n", quality.precision, quality.why_not);
  const DeviceQuality& q = *quality.measured;
  return fmt::format(
      "   {:<6} error of rho at most {:.1e} in {} ordinary cases, {} of which say that they miss {:g}{}\n",
      quality.precision, q.worst_error, q.cases, q.missed, q.tolerance,
      q.is_sound ? "" : "; SOME ERRORS EXCEED THEIR ESTIMATES, see dolp verify --hard-cases");
}

nlohmann::ordered_json quality_json(const Quality& quality) {
  if (!quality.measured) return {{"why_not", quality.why_not}};
  const DeviceQuality& q = *quality.measured;
  const auto error = std::isfinite(q.worst_error) ? nlohmann::ordered_json(q.worst_error) : nlohmann::ordered_json();
  return {{"tolerance", q.tolerance}, {"cases", q.cases},           {"missed_tolerance", q.missed},
          {"worst_rho_error", error}, {"worst_case", q.worst_case}, {"sound", q.is_sound}};
}

std::vector<Quality> qualities_of(const DeviceDescription& device, std::size_t position) {
  return {quality_in(device, position, Precision::kFloat), quality_in(device, position, Precision::kDouble)};
}

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
  nlohmann::ordered_json json = {{"devices", nlohmann::ordered_json::array()}, {"why_empty", list.why_empty}};
  for (std::size_t i = 0; i < list.devices.size(); ++i) {
    const DeviceDescription& device = list.devices[i];
    nlohmann::ordered_json of_device = device_json(device, i);
    if (!options.json) fmt::print("{}", device_text(device, i));
    for (const Quality& quality : qualities_of(device, i)) {
      of_device["quality"][quality.precision] = quality_json(quality);
      if (!options.json) fmt::print("{}", quality_text(quality));
    }
    json["devices"].push_back(of_device);
  }
  if (options.json) fmt::print("{}\n", json.dump(2));
  if (list.devices.empty()) throw DeviceError(list.why_empty);
  choose_device(list.devices, options.device, false);  // says why when no device can be used
  return kExitDone;
}

}  // namespace dolp::cli
