#include "studies/study_run.hpp"
#include "base/stopwatch.hpp"

#include <cmath>
#include <cstdio>

#include "base/atomic_file.hpp"
#include "device/devices.hpp"
#include "studies/context.hpp"
#include "studies/report.hpp"
#include "terminal/terminal.hpp"

namespace dolp::bench {
namespace {

using nlohmann::ordered_json;

ordered_json measured(const StudyOptions& options, const StudyParts& parts) {
  ProgressBar bar(options.quiet);
  StudyRun run(options, bar.callback());
  parts.measure(run);
  return run.result();
}

}  // namespace

void StudyRun::describe(const std::string& study, const std::string& error, const std::string& time_s) {
  json_["study"] = study;
  json_["context"] = context_json(options_.device, options_.arguments);
  json_["error"] = error;
  json_["time_s"] = time_s;
  json_["results"] = ordered_json::array();
}

void StudyRun::finish(const ordered_json& row) {
  json_["results"].push_back(row);
  if (!progress_(++done_, total_)) throw Cancelled();
}

ordered_json StudyRun::result() {
  const double wall_s = seconds_since(start_);
  json_["wall_s"] = std::round(10.0 * wall_s) / 10.0;
  return std::move(json_);
}

void run_study(const StudyOptions& options, const StudyParts& parts) {
  if (!options.json_path.empty()) check_writable(options.json_path);
  ordered_json result = measured(options, parts);
  add_warnings(result);
  parts.warn(result);
  if (options.json_path != "-") fmt::print("{}", parts.table_text(result));
  std::fflush(stdout);
  for (const ordered_json& warning : result["warnings"]) {
    fmt::print(stderr, "warning: {}\n", warning.get<std::string>());
  }
  if (!options.json_path.empty()) write_text_atomically(options.json_path, json_text(std::move(result)));
}

void check_device(const StudyOptions& options) {
  if (!options.device.empty()) choose_device(list_devices().devices, options.device, false);
}

std::string time_text(double time_s) {
  if (time_s < 1e-6) return fmt::format("{:.3g} ns", 1e9 * time_s);
  if (time_s < 1e-3) return fmt::format("{:.3g} us", 1e6 * time_s);
  return time_s < 1.0 ? fmt::format("{:.3g} ms", 1e3 * time_s) : fmt::format("{:.3g} s", time_s);
}

}  // namespace dolp::bench
