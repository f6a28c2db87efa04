#include <fmt/format.h>

#include <vector>

#include "base/error.hpp"
#include "cli/commands.hpp"
#include "report/report.hpp"
#include "scene/scene_reader.hpp"
#include "scene/text.hpp"
#include "terminal/exit_status.hpp"

namespace dolp::cli {
namespace {

std::string default_text(const KeyDescription& description) {
  if (description.fallback.empty()) return "absent when not given";
  return description.fallback == "required" ? "required" : "default " + description.fallback;
}

Report key_report(const KeyDescription& description) {
  Report report;
  report.line("{}", key("key", description.key));
  report.line("    {}", key("meaning", description.meaning));
  report.line("    {}{}; {}", description.allowed(),
              description.unit.empty() || description.unit == "1" ? "" : ", " + description.unit,
              default_text(description));
  report.value("unit", description.unit);
  report.value("allowed", description.allowed());
  report.value("default", description.fallback);
  return report;
}

}  // namespace

int run_keys(const Options& options) {
  std::vector<Report> keys;
  std::vector<std::string> names;
  for (const KeyDescription& description : scene_keys()) {
    names.push_back(description.key);
    const bool is_wanted =
        options.key.empty() || description.key == options.key || description.key.starts_with(options.key + ".");
    if (is_wanted) keys.push_back(key_report(description));
  }
  if (keys.empty()) {
    throw InputError(fmt::format("{}: is no key of a scene; the nearest is {}", one_line(options.key),
                                 nearest_name(options.key, names)));
  }
  Report report;
  report.add("keys", keys);
  report.print(options.json, false);
  return kExitDone;
}

}  // namespace dolp::cli
