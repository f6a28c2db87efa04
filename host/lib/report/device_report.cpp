#include "report/verify_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <dolp/errors.hpp>
#include <string>
#include <vector>

#include "base/numbers.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "model/choices.hpp"

namespace dolp {
namespace {

/// The requested tolerance: near the best that the arithmetic can reach.
double tolerance_in(Precision precision) { return precision == Precision::kDouble ? 1e-9 : 1e-6; }

/// The results of ordinary cases in one precision, or the reason why there are none.
struct Quality {
  Precision precision;
  std::string why_not;
  std::vector<CaseOutcome> outcomes = {};
};

Quality quality_in(const Device& device, std::size_t position, Precision precision) {
  const bool in_double = precision == Precision::kDouble;
  Quality quality{precision, device.usable ? "" : "the device is not usable"};
  if (in_double && !device.has_double) quality.why_not = "the device has no double precision (shaderFloat64)";
  if (!quality.why_not.empty()) return quality;
  try {
    VulkanOptions options;
    options.device = std::to_string(position);
    options.needs_double = in_double;
    VulkanEvaluator evaluator(options);
    quality.outcomes = qualify(ordinary_cases(), evaluator, {tolerance_in(precision), precision}, {});
  } catch (const DeviceError& error) {
    quality.why_not = error.what();
  }
  return quality;
}

ReportBuilder quality_report(const Quality& quality) {
  ReportBuilder report;
  if (quality.outcomes.empty()) {
    report.line("   {:<6} not measured: {}", name_of(quality.precision), key("why_not", quality.why_not));
    return report;
  }
  const auto error_of = [](const CaseOutcome& one) { return std::isnan(one.rho.error) ? kInfinity : one.rho.error; };
  const CaseOutcome& worst = *std::ranges::max_element(quality.outcomes, {}, error_of);
  const auto missed = std::ranges::count_if(quality.outcomes, &CaseOutcome::misses_tolerance);
  const bool is_sound =
      std::ranges::all_of(quality.outcomes, [](const CaseOutcome& one) { return one.complaint.empty(); });
  report.line(
      "   {:<6} true error of rho at most {:.1e} in {} ordinary cases; with tolerance {:g}, {} of them get status 2 or "
      "16, because the stated bound, larger than the error, misses it{}",
      name_of(quality.precision), key("worst_rho_error", worst.rho.error), key("cases", quality.outcomes.size()),
      key("tolerance", tolerance_in(quality.precision)), key("missed_tolerance", missed),
      is_sound ? "" : "; SOME ERRORS EXCEED THEIR ESTIMATES, see dolp verify --hard-cases");
  const StoredCase& stored = worst.stored;
  report.value("worst_case",
               fmt::format("{} {} {}", name_of(stored.distribution), name_of(stored.masking), stored.name));
  report.value("sound", is_sound);
  return report;
}

ReportBuilder device_report(const Device& device, std::size_t position) {
  const Quality in_float = quality_in(device, position, Precision::kFloat);
  Device examined = device;  // its kernels may not compile or run, though the driver calls it usable
  if (device.usable) examined.why_not = in_float.why_not;
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
    report.add((std::string("quality/") + name_of(quality.precision)).c_str(), quality_report(quality));
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
