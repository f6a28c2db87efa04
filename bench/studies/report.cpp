#include "studies/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "studies/timing.hpp"

namespace dolp::bench {
namespace {

using nlohmann::ordered_json;

constexpr double kAcceptedSpread = 0.2;
constexpr double kAcceptedLoad = 0.3;  // a larger load per core at the start of the study causes a warning

/// The first four names, and how many more there are.
std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t kMostNames = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNames); ++i) text += (i > 0 ? ", " : "") + names[i];
  return names.size() > kMostNames ? text + fmt::format(" and {} more", names.size() - kMostNames) : text;
}

/// The name that warnings use for a row, such as "gauss easy 64" or "masking hemispherical smith".
std::string row_name(const ordered_json& row) {
  const auto text = [&](const char* key) {
    const ordered_json& value = row[key];
    return value.is_number() ? fmt::format("{:g}", value.get<double>()) : value.get<std::string>();
  };
  const char* first = row.contains("method") ? "method" : row.contains("effect") ? "effect" : "part";
  return fmt::format("{} {} {}", text(first), text("case"), text(row.contains("tolerance") ? "tolerance" : "setting"));
}

void warn_of_times(ordered_json& result) {
  std::vector<std::string> noisy;
  std::vector<std::string> single;
  for (const ordered_json& row : result["results"]) {
    if (!row.contains("raw_times_s")) continue;
    const auto raw_s = row["raw_times_s"].get<std::vector<double>>();
    const std::string name = row_name(row);
    if (raw_s.size() == 1) single.push_back(name);
    if (spread(raw_s) > kAcceptedSpread) noisy.push_back(name);
  }
  ordered_json& warnings = result["warnings"];
  if (!noisy.empty()) {
    warnings.push_back(fmt::format(
        "{} of {} times lie over {:.0f} % above their minimum: end other programs, run again or use time_min_s ({})",
        noisy.size(), result["results"].size(), 100.0 * kAcceptedSpread, some_of(noisy)));
  }
  if (!single.empty()) {
    warnings.push_back(
        fmt::format("{} slow settings were timed once, without a warm-up: read their times to one digit ({})",
                    single.size(), some_of(single)));
  }
}

void warn_of_conditions(ordered_json& result) {
  ordered_json& warnings = result["warnings"];
  const ordered_json& machine = result["context"]["machine"];
  if (machine["load"].get<double>() > kAcceptedLoad * machine["cores"].get<double>()) {
    warnings.push_back(fmt::format(
        "busy machine (load {:.1f} on {} cores), methods on all cores lose most: end other programs, run again",
        machine["load"].get<double>(), machine["cores"].get<unsigned>()));
  }
  if (result["context"]["compiler"]["build_type"] != "Release") {
    warnings.push_back("this is no Release build: configure with -DCMAKE_BUILD_TYPE=Release before using the times");
  }
  if (result["context"]["validation"]) {
    warnings.push_back("the Vulkan validation layer is on: unset DOLP_VALIDATION before using the times of vulkan-*");
  }
}

}  // namespace

void add_warnings(ordered_json& result) {
  result["warnings"] = ordered_json::array();
  warn_of_times(result);
  warn_of_conditions(result);
}

ordered_json method_json(const Method& method) {
  return {{"name", method.name},
          {"label", method.label},
          {"what", method.what},
          {"cores", method.cores},
          {"setting", method.setting_name}};
}

void note_where(ordered_json& result, const Method& method, const Solver& solver) {
  for (ordered_json& described : result["methods"]) {
    if (described["name"] == method.name) described["where"] = solver.where();
  }
}

std::string json_text(ordered_json result) {
  std::string rows;
  for (const ordered_json& row : result["results"]) rows += (rows.empty() ? "\n  " : ",\n  ") + row.dump();
  result.erase("results");
  std::string text = result.dump(1);
  text.resize(text.rfind('\n'));
  return text + ",\n \"results\": [" + rows + "\n ]\n}\n";
}

}  // namespace dolp::bench
