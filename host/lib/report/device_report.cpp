#include "report/device_report.hpp"

#include <fmt/format.h>

#include <dolp/errors.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "model/choices.hpp"
#include "model/moments.hpp"
#include "verify/qualification.hpp"

namespace dolp {
namespace {

// Requested tolerance of each arithmetic: near the best that it can reach.
constexpr double kFloatTolerance = 1e-6;
constexpr double kDoubleTolerance = 1e-9;

/// A device's accuracy in one precision, or the reason why it is unknown.
struct Quality {
  const char* precision;
  std::optional<DeviceQuality> measured;
  std::string why_not;
};

Quality quality_in(const Device& device, std::size_t position, Precision precision) {
  const bool in_double = precision == Precision::kDouble;
  Quality quality{name_of(precision), {}, {}};
  if (!device.usable) quality.why_not = "the device is not usable";
  if (in_double && !device.has_double) quality.why_not = "the device has no double precision (shaderFloat64)";
  if (!quality.why_not.empty()) return quality;
  try {
    VulkanOptions options;
    options.device = std::to_string(position);
    options.needs_double = in_double;
    VulkanEvaluator evaluator(options);
    quality.measured = measure_quality(evaluator, {in_double ? kDoubleTolerance : kFloatTolerance, precision});
  } catch (const DeviceError& error) {
    quality.why_not = error.what();
  }
  return quality;
}

ReportBuilder quality_report(const Quality& quality) {
  ReportBuilder report;
  if (!quality.measured) {
    report.line("   {:<6} not measured: {}", quality.precision, key("why_not", quality.why_not));
    return report;
  }
  const DeviceQuality& q = *quality.measured;
  report.line(
      "   {:<6} true error of rho at most {:.1e} in {} ordinary cases; with tolerance {:g} {} of them get status 2 or "
      "16, "
      "because "
      "the stated bound, larger than the error, misses it{}",
      quality.precision, key("worst_rho_error", q.worst_error), key("cases", q.cases), key("tolerance", q.tolerance),
      key("missed_tolerance", q.missed),
      q.is_sound ? "" : "; SOME ERRORS EXCEED THEIR ESTIMATES, see dolp verify --hard-cases");
  report.values({{"worst_case", q.worst_case}, {"sound", q.is_sound}});
  return report;
}

/// The reason why a device that the driver calls usable is not: its kernels do not compile or run.
std::string why_not_usable(const Device& device, const Quality& in_float) {
  if (!device.usable) return device.why_not;
  return in_float.measured ? "" : in_float.why_not;
}

ReportBuilder device_report(const Device& device, std::size_t position) {
  const Quality in_float = quality_in(device, position, Precision::kFloat);
  Device examined = device;
  examined.why_not = why_not_usable(device, in_float);
  examined.usable = examined.why_not.empty();
  const Quality in_double = quality_in(examined, position, Precision::kDouble);
  ReportBuilder report;
  report.line("{}: {} ({})", key("index", position), key("name", device.name), type_name(device.type));
  report.line("   {}, Vulkan {}", key("driver", device.driver), key("api_version", device.api_version));
  report.line("   {}{}", examined.usable ? "usable" : "not usable: ", key("why_not", examined.why_not));
  report.line(
      "   double precision {}{}, storage buffer {:.0f} MiB, heap {:.0f} MiB, {} workgroups, subgroup {}, timestamps {}",
      device.has_double ? "yes" : "no",
      device.has_double ? "" : fmt::format(" (tolerances below {:g} are out of reach)", kLeastFloatTolerance),
      static_cast<double>(device.max_storage_buffer_bytes) / kMebibyte,
      static_cast<double>(device.memory_bytes) / kMebibyte, key("max_workgroups", device.max_workgroups),
      key("subgroup_size", device.subgroup_size), device.timestamps ? "yes" : "no");
  report.values({{"type", type_name(device.type)},
                 {"usable", examined.usable},
                 {"float64", device.has_double},
                 {"max_storage_buffer_bytes", device.max_storage_buffer_bytes},
                 {"heap_bytes", device.memory_bytes},
                 {"timestamps", device.timestamps}});
  for (const Quality& quality : {in_float, in_double}) {
    report.add((std::string("quality/") + quality.precision).c_str(), quality_report(quality));
  }
  return report;
}

}  // namespace

ReportBuilder device_report(const DeviceList& list) {
  std::vector<ReportBuilder> devices;
  for (std::size_t i = 0; i < list.devices.size(); ++i) devices.push_back(device_report(list.devices[i], i));
  ReportBuilder report;
  report.add("devices", devices);
  report.value("why_empty", list.why_empty);
  return report;
}

}  // namespace dolp
