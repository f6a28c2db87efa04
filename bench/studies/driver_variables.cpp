#include "studies/driver_variables.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <dolp/errors.hpp>

#include "base/temporary_folder.hpp"
#include "methods/method.hpp"
#include "studies/child.hpp"
#include "studies/context.hpp"
#include "studies/timing.hpp"

namespace dolp::bench {
namespace {

using nlohmann::ordered_json;

ordered_json rows_of_child(const std::vector<std::string>& assignments, const StudyOptions& options,
                           std::size_t entries) {
  std::vector<std::string> arguments = {"env"};
  arguments.insert(arguments.end(), assignments.begin(), assignments.end());
  arguments.insert(arguments.end(), {own_program(), "throughput", "--quiet", "--case", "kernels", "--entries",
                                     std::to_string(entries), "--json", "-"});
  if (options.quick) arguments.emplace_back("--quick");
  if (!options.device.empty()) arguments.insert(arguments.end(), {"--device", options.device});
  const ChildOutcome outcome = run_child(arguments, ChildErrors::kHidden);
  ordered_json result = ordered_json::parse(outcome.out, nullptr, false);
  if (outcome.status != 0 || !result.is_object()) throw Unavailable(shell_line(arguments) + " failed");
  return result["results"];
}

}  // namespace

std::vector<ordered_json> kernels_with(const DriverVariable& variable, const StudyOptions& options, std::size_t entries,
                                       std::size_t rounds) {
  const TemporaryFolder folder("dolp-bench");
  std::vector<ordered_json> children(variable.settings.size());
  for (std::size_t round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < children.size(); ++i) {
      std::vector<std::string> assignments = {fmt::format("{}={}", variable.name, variable.settings[i])};
      if (variable.changes_code) {
        assignments.push_back(fmt::format("MESA_SHADER_CACHE_DIR={}/{}", folder.path().string(), variable.settings[i]));
      }
      const ordered_json rows = rows_of_child(assignments, options, entries);
      if (round == 0) children[i] = rows;
      for (std::size_t j = 0; round > 0 && j < rows.size(); ++j) {
        ordered_json& raw = children[i][j]["raw_times_s"];
        raw.insert(raw.end(), rows[j]["raw_times_s"].begin(), rows[j]["raw_times_s"].end());
      }
    }
  }
  std::vector<ordered_json> rows;
  for (std::size_t i = 0; i < children.size(); ++i) {
    for (std::size_t j = 0; j < children[i].size(); ++j) {
      const auto times_s = children[i][j]["raw_times_s"].get<std::vector<double>>();
      const auto first_s = children[0][j]["raw_times_s"].get<std::vector<double>>();
      rows.push_back({{"case", children[i][j]["case"]},
                      {"setting", variable.settings[i]},
                      {"entries", children[i][j]["entries"]},
                      {"time_s", median(times_s)},
                      {"time_min_s", minimum(times_s)},
                      {"speedup", minimum(first_s) / minimum(times_s)},
                      {"raw_times_s", times_s}});
    }
  }
  return rows;
}

}  // namespace dolp::bench
