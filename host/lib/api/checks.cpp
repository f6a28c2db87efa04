// Tables and devices against references.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include <dolp/number_range.hpp>
#include "api/reports.hpp"
#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "device/devices.hpp"
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "model/choices.hpp"
#include "report/device_report.hpp"
#include "report/verify_report.hpp"
#include "run/scene_run.hpp"
#include "run/table_scene.hpp"
#include "table/table_reader.hpp"
#include "verify/response_check.hpp"

namespace dolp {
namespace {

std::unique_ptr<ModelEvaluator> evaluator_in(Precision precision, const DeviceCheckOptions& options) {
  if (options.evaluator == "cpu") return std::make_unique<CpuEvaluator>();
  VulkanOptions vulkan;
  vulkan.device = options.device;
  vulkan.needs_double = precision == Precision::kDouble;
  return std::make_unique<VulkanEvaluator>(vulkan);
}

/// The precisions to examine. `left_out` says why one is missing that auto would include.
std::vector<Precision> precisions_of(const DeviceCheckOptions& options, std::string& left_out) {
  const std::optional<Precision> wanted = named<Precision>(options.precision);
  if (!wanted) throw InputError("precision " + one_line(options.precision) + ": must be auto, float or double");
  if (*wanted != Precision::kAuto) return {*wanted};
  if (options.evaluator == "cpu") return {Precision::kFloat, Precision::kDouble};
  const DeviceList list = list_devices();
  if (list.devices.empty()) throw DeviceError(list.why_empty);
  const Device& device = list.devices[choose_device(list.devices, options.device, false)];
  if (device.has_double) return {Precision::kFloat, Precision::kDouble};
  left_out = "double is left out: " + device.name + " has no double precision (shaderFloat64)";
  return {Precision::kFloat};
}

}  // namespace

Report verify(const std::filesystem::path& path, const TableCheckOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const std::string name = path.string();
  check_may_hold_scene(name);
  const TableReader reader(path);
  const SceneValues scene =
      table_scene(reader.head(), name, options.named_files ? NamedData::kOfFiles : NamedData::kOfTable);
  TableReport report;
  report.path = name;
  report.title = scene.title;
  report.options = options;
  TableSample sample;
  sample.positions = sample_positions(reader.head().size(), report.options);
  sample.table = reader.read_entries(sample.positions, options.progress);
  const bool is_response = !sample.table.beta_deg.empty();
  report.check = (is_response ? check_responses : check_table)(sample, scene, name, options.progress);
  report.wall_s = seconds_since(start);
  return public_report(table_report(report), report.check.passed());
}

Report verify_device(const DeviceCheckOptions& options) {
  if (!kToleranceRange.contains(options.tolerance)) {
    throw InputError(fmt::format("tolerance {:g}: must be a number in {}", options.tolerance, kToleranceRange.text()));
  }
  begin(options.progress, 1);
  HardCaseReport report;
  report.tolerance = options.tolerance;
  report.cases = hard_cases();
  for (const Precision precision : precisions_of(options, report.left_out)) {
    const std::unique_ptr<ModelEvaluator> evaluator = evaluator_in(precision, options);
    PrecisionReport& of_precision = report.precisions.emplace_back();
    of_precision.outcomes = qualify(report.cases, *evaluator, {report.tolerance, precision}, options.progress);
    of_precision.evaluation = evaluator->report();
  }
  return public_report(hard_case_report(report, options.all), report.failures() == 0);
}

Report device_report() {
  const ReportBuilder report = device_report(list_devices());
  const bool is_any_usable =
      std::ranges::any_of(report.json()["devices"], [](const auto& d) { return d["usable"] == true; });
  return public_report(report, is_any_usable);
}

}  // namespace dolp
