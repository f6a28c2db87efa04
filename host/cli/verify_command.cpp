#include <chrono>
#include <optional>

#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "cli/commands.hpp"
#include "cli/run_report.hpp"
#include "cli/verify_report.hpp"
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "evaluate/vulkan/devices.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "model/choices.hpp"
#include "run/table_scene.hpp"
#include "scene/number_range.hpp"
#include "scene/text.hpp"
#include "terminal/exit_status.hpp"
#include "terminal/progress_bar.hpp"

namespace dolp::cli {
namespace {

constexpr double kDefaultTolerance = 1e-4;

int verify_table(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  const Table table = load_table(options.table_path);
  const Scene scene =
      table_scene(table, options.table_path, options.named_files ? NamedData::kOfFiles : NamedData::kOfTable);
  TableReport report;
  report.path = options.table_path;
  report.title = scene.title;
  report.options = {options.samples, options.seed};
  {
    ProgressBar bar(options.quiet);
    report.check = check_table(table, scene, options.table_path, report.options, bar.callback());
  }
  report.wall_s = seconds_since(start);
  table_report(report).print(options.json, options.quiet);
  return report.check.passed() ? kExitDone : kExitAccuracy;
}

double tolerance_of(const Options& options) {
  if (options.tolerance.empty()) return kDefaultTolerance;
  const std::optional<double> tolerance = parse_number(options.tolerance);
  if (!tolerance || !kToleranceRange.contains(*tolerance)) {
    throw InputError(
        fmt::format("--tolerance {}: must be a number in {}", one_line(options.tolerance), kToleranceRange.text()));
  }
  return *tolerance;
}

std::unique_ptr<MomentsEvaluator> evaluator_in(Precision precision, const Options& options) {
  if (options.evaluator == "cpu") return std::make_unique<CpuEvaluator>(precision);
  VulkanOptions vulkan;
  vulkan.device = options.device;
  vulkan.precision = precision;
  return std::make_unique<VulkanEvaluator>(vulkan);
}

/// The precisions to examine. `left_out` says why one is missing that --precision auto would include.
std::vector<Precision> precisions_of(const Options& options, std::string& left_out) {
  const std::optional<Precision> wanted = named<Precision>(options.precision);
  if (wanted && *wanted != Precision::kAuto) return {*wanted};
  if (options.evaluator == "cpu") return {Precision::kFloat, Precision::kDouble};
  const DeviceList list = list_devices();
  if (list.devices.empty()) throw DeviceError(list.why_empty);
  const DeviceDescription& device = list.devices[choose_device(list.devices, options.device, false)];
  if (device.float64) return {Precision::kFloat, Precision::kDouble};
  left_out = "double is left out: " + device.name + " has no double precision (shaderFloat64)";
  return {Precision::kFloat};
}

int verify_hard_cases(const Options& options) {
  HardCaseReport report;
  report.tolerance = tolerance_of(options);
  report.cases = hard_cases();
  for (const Precision precision : precisions_of(options, report.left_out)) {
    const std::unique_ptr<MomentsEvaluator> evaluator = evaluator_in(precision, options);
    ProgressBar bar(options.quiet);
    PrecisionReport& of_precision = report.precisions.emplace_back();
    of_precision.outcomes = qualify(report.cases, *evaluator, report.tolerance, bar.callback());
    of_precision.evaluation = evaluator->report();
  }
  hard_case_report(report, options.all).print(options.json, options.quiet);
  return report.failures() == 0 ? kExitDone : kExitAccuracy;
}

}  // namespace

int run_verify(const Options& options) {
  if (!options.hard_cases && options.table_path.empty()) {
    throw InputError("verify: name a TABLE, or --hard-cases to examine a device (see dolp verify --help)");
  }
  return options.hard_cases ? verify_hard_cases(options) : verify_table(options);
}

}  // namespace dolp::cli
