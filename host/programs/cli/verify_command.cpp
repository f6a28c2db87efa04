#include <fmt/format.h>

#include <dolp/errors.hpp>
#include <optional>

#include "base/text.hpp"
#include "cli/commands.hpp"
#include "terminal/exit_status.hpp"
#include "terminal/progress_bar.hpp"

namespace dolp::cli {
namespace {

Report verify_device(const Options& options, const Progress& progress) {
  DeviceCheckOptions check{options.evaluator, options.device};
  if (!options.precision.empty()) check.precision = options.precision;
  if (!options.tolerance.empty()) {
    const std::optional<double> tolerance = parse_number(options.tolerance);
    if (!tolerance) {
      throw InputError(
          fmt::format("--tolerance {}: must be {}", one_line(options.tolerance), allowed("accuracy.tolerance")));
    }
    check.tolerance = *tolerance;
  }
  check.all = options.all;
  check.progress = progress;
  return verify_device(check);
}

Report examine(const Options& options, const Progress& progress) {
  if (options.hard_cases) return verify_device(options, progress);
  return verify(options.table_path, {options.samples, options.seed, options.named_files, progress});
}

}  // namespace

int run_verify(const Options& options) {
  if (!options.hard_cases && options.table_path.empty()) {
    throw InputError("verify: name a TABLE, or --hard-cases to examine a device (see dolp verify --help)");
  }
  const Report report = examine(options, ProgressBar(options.quiet).callback());
  print(report, options);
  return report.is_good ? kExitDone : kExitAccuracy;
}

}  // namespace dolp::cli
